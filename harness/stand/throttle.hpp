// The stand's throttle source: set-points at 50 Hz and status reads at 20 Hz over I2C.
//
//   Start    set-point 0 from power-up on: the zeros that arm
//   Wire     a set-point has passed when the reply to its write says that it was acknowledged
//   Told     status of the last read whose CRC is right; NaN before
#pragma once
#include <cmath>
#include <cstdint>

#include "io_bridges/link/messages.hpp"
#include "io_bridges/protocols/esc_codec.hpp"

namespace whirl::stand {

class Throttle {
 public:
  struct Told {
    double current_A = std::nan(""), speed_rpm = std::nan(""), flags = std::nan("");
    std::uint64_t replies = 0, refused = 0;  // refused: not acknowledged, timed out or bad CRC
  };

  Throttle(std::uint8_t address, std::uint16_t bus) : address_(address), bus_(bus) {}

  void set(std::uint16_t v) {
    v_ = v;
    on_wire_ns_ = -1;
    first_ = sent_;
  }
  void silence(bool silent) { silent_ = silent; }  // no more writes; reads go on
  std::uint16_t value() const { return v_; }
  const Told& told() const { return told_; }
  std::int64_t on_wire_ns() const { return on_wire_ns_; }  // of the last set(); -1: not yet

  // What goes out in [t_ns, t_ns + 1 ms).
  void send(std::int64_t t_ns, io::Batch& sensed);
  void take(const io::Reader& reply);

 private:
  void order(std::int64_t t_ns, std::uint16_t read, const void* bytes, std::uint32_t size,
             io::Batch& sensed);

  std::uint8_t address_;
  std::uint16_t bus_;
  std::uint16_t v_ = 0;
  bool silent_ = false;
  std::uint32_t sent_ = 0, first_ = 0;  // orders so far; the first that can carry v_
  std::int64_t on_wire_ns_ = -1;
  Told told_;
};

}  // namespace whirl::stand

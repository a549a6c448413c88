// The stand's throttle source: set-points at 50 Hz (or another rate) and status reads at 20 Hz over I2C.
//
//   Start    set-point 0 from power-up on: the zeros that arm
//   Wire     a set-point has passed when the reply to its write says that it was acknowledged
//   Reported status of the last read whose CRC is right; NaN before
//   Raw      any bytes and lengths beside them: what a careless master might send
#pragma once
#include <cmath>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "io_bridges/messages/messages.hpp"
#include "io_bridges/protocols/esc_codec.hpp"

namespace whirl::stand {

class Throttle {
 public:
  struct Reported {
    double current_A = std::nan(""), speed_rpm = std::nan(""), flags = std::nan("");
    std::uint64_t replies = 0, refused = 0;  // refused: not acknowledged, timed out or bad CRC
    double stretched_s = 0.0;  // longest hold of SCL in the transfers of the latest step with any
  };
  struct Raw {  // a transfer as it stands, some times over
    std::vector<std::uint8_t> write;
    std::uint16_t read = 0;
    std::int64_t times = 1, every_ns = 1'000'000;    // whole steps
    std::int64_t offset_ns = 250'000, shift_ns = 0;  // in its step; moved each time, and wraps
    std::int64_t next_ns = 0;
  };
  struct RawReported {
    std::uint64_t replies = 0, acked = 0;
    double read_bytes = std::nan("");  // of the last read
    // 1: the status and its CRC in the first six bytes, 0xFF in all that follow; fewer: a NaN
    double read_good = std::nan("");
  };

  Throttle(std::uint8_t address, std::uint16_t bus) : address_(address), bus_(bus) {}

  void set(std::uint16_t v) {
    v_ = v;
    on_wire_ns_ = -1;
    first_ = sent_;
  }
  void silence(bool silent) { silent_ = silent; }  // no more writes; reads go on
  bool silent() const { return silent_; }
  void never_write() { writes_ = false; }                     // another wire carries the set-points
  void send_raw(Raw raw) { raw_.push_back(std::move(raw)); }  // one after another
  void set_rate(double writes_Hz);
  std::uint16_t value() const { return v_; }
  const RawReported& raw_reported() const { return raw_reported_; }
  const Reported& reported() const { return reported_; }
  std::int64_t on_wire_ns() const { return on_wire_ns_; }  // of the last set(); -1: not yet

  // What goes out in [t_ns, t_ns + 1 ms).
  void send(std::int64_t t_ns, io::Batch& sensed);
  void on_message(const io::Reader& reply);

 private:
  void send_next_raw(std::int64_t t_ns, io::Batch& sensed);
  void take_raw(const io::I2cReplyHead& head, std::span<const std::uint8_t> bytes);
  void order(std::int64_t t_ns, std::uint16_t read, const void* bytes, std::uint32_t size,
             io::Batch& sensed);

  std::uint8_t address_;
  std::uint16_t bus_;
  std::uint16_t v_ = 0;
  bool silent_ = false, writes_ = true;
  std::uint32_t sent_ = 0, first_ = 0;  // orders so far; the first that can carry v_
  std::int64_t on_wire_ns_ = -1;
  std::int64_t write_every_ns_ = 20'000'000;
  Reported reported_;
  std::int64_t reported_step_ = -1;  // of reported_.stretched_s
  std::deque<Raw> raw_;
  std::deque<std::uint32_t> raw_numbers_;  // orders without a reply yet
  RawReported raw_reported_;
};

}  // namespace whirl::stand

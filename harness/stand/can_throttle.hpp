// The stand's throttle source over CAN: esc.RawCommand at 50 Hz (or another rate), as a flight controller
// sends it, and what the ESC tells of itself.
//
//   Start    set-point 0 from power-up on: the zeros that arm
//   Scale    four steps of the command are one of the I2C protocol's 2047 (docs of esc_dronecan)
//   Speed    of an ESC in the mode `rpm` the same as esc.RPMCommand, where the stand says so
//   Wire     a set-point has passed when its frame has, acknowledged
//   Reported by esc.Status and StatusExtended; refused counts our frames that failed
#pragma once
#include <vector>

#include "harness/stand/throttle.hpp"
#include "io_bridges/messages/messages.hpp"
#include "io_bridges/protocols/dronecan/assembler.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"

namespace whirl::stand {

class CanThrottle {
 public:
  CanThrottle(std::uint16_t motor, std::uint16_t bus, bool by_speed = false);

  void set(std::uint16_t v) {
    v_ = v;
    on_wire_ns_ = -1;
    changed_ = true;
  }
  void silence(bool silent) { silent_ = silent; }
  void set_rate(double writes_Hz) { every_ns_ = std::llround(1e9 / writes_Hz); }
  std::uint16_t value() const { return v_; }
  const Throttle::Reported& reported() const { return reported_; }
  std::int64_t on_wire_ns() const { return on_wire_ns_; }  // of the last set(); -1: not yet

  // What goes out in [t_ns, t_ns + 1 ms).
  void send(std::int64_t t_ns, io::Batch& sensed);
  void on_message(const io::Reader& transfer);

 private:
  std::vector<io::CanFrame> command();
  template <typename Command, typename List, typename Count>
  std::vector<io::CanFrame> command_of(List Command::*counts, Count own);
  void on_status(const io::dronecan::Transfer& transfer);

  std::uint16_t motor_, bus_;
  bool by_speed_;
  std::uint16_t v_ = 0;
  bool silent_ = false, changed_ = false;
  std::int64_t every_ns_ = 20'000'000, on_wire_ns_ = -1;
  std::uint8_t transfer_id_ = 0, awaited_id_ = 0;  // of the first frame that carries v_
  bool awaited_ = false;
  Throttle::Reported reported_;
  io::dronecan::Assembler assembler_;
};

}  // namespace whirl::stand

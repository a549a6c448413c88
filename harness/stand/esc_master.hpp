// Who commands the ESC of a stand, virtual or real: set-points over I2C or as pulses, status reads, the serial
// line; and what the ESC tells of itself.
//
//   Command  SetPoint in the ESC's mode, Stop, Silence, SetPointRate, RawTransfer, Pulses, Line
//   Orders   i2c_order, pulse_train and uart_frame messages, which a virtual board or a bench's links carry
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "harness/stand/can_throttle.hpp"
#include "harness/stand/esc_line.hpp"
#include "harness/stand/pulse_output.hpp"
#include "harness/stand/throttle.hpp"
#include "harness/world/world.hpp"

namespace whirl::stand {

struct EscMasterParams {
  io::EscMode mode =
      io::EscMode::thrust_by_rpm;  // what the ESC is set to; it scales the set-points
  std::uint8_t address = 0x29;
  double pulse_rate_Hz = 0.0;  // of the throttle's pulses; 0: it writes over I2C
  std::uint16_t i2c = 2, serial = 1, motor = 1;
  std::uint16_t can = 0;     // the bus on which it speaks DroneCAN; 0: none
  bool rpm_command = false;  // and by RPMCommand, in mode rpm
};

class EscMaster {
 public:
  explicit EscMaster(const EscMasterParams& params);

  // False: nothing that an ESC is told. Errors  as World::command
  Result<bool> take(const Command& command);
  void on_message(const io::Reader& message);  // ignores what is not from the ESC
  void send(std::int64_t t_ns, io::Batch& sensed);
  Result<Done> ask(const std::string& line) { return line_.ask(line); }
  const std::vector<std::string>& heard() const { return line_.heard(); }
  std::int64_t on_wire_ns() const {
    return on_can() ? can_.on_wire_ns() : throttle_.on_wire_ns();
  }  // of the last set-point; -1: not yet
  const Throttle::Reported& reported() const {
    return on_can() ? can_.reported() : throttle_.reported();
  }

  // What is commanded and told. They live as long as this does.
  std::vector<EscLine::Named> signals() const;

 private:
  Result<bool> set(const request::SetPoint& command);
  bool on_can() const { return params_.can > 0; }
  void set(std::uint16_t v);

  EscMasterParams params_;
  Throttle throttle_;
  CanThrottle can_;
  PulseOutput pulses_;
  EscLine line_;
};

}  // namespace whirl::stand

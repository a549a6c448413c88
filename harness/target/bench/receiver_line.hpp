// The bench as a flight controller's radio-control receiver with SBUS, on a serial line of this host
// (serial_rack_link.hpp): the receiver of the board file, with its faults, hears the plan's sticks.
//
//   Line     100000 baud 8E2, inverted on copper: by the adapter (an FT232R can, see docs/bench.md), or by a transistor where
//            the board has no inverter before its UART
//   Frame    leaves whole when its last character is over: on copper it begins 3 ms later than a receiver's would
//   Safe     nothing goes out any more, as of a receiver without supply
#pragma once
#include "harness/target/bench/serial_rack_link.hpp"

namespace whirl::bench {

class ReceiverLine final : public SerialRackLink {
 public:
  explicit ReceiverLine(LinePartOptions options);

  Result<Done> open() override;

 private:
  Result<Done> take_in(std::int64_t now_host_ns) override;
  Result<Done> send_waiting(std::int64_t now_host_ns) override;

  LinePartOptions options_;
};

}  // namespace whirl::bench

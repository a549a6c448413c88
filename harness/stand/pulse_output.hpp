// The stand's receiver: set-points as servo pulses on the ESC's throttle pin.
//
//   Width   0: 1000 us; 1..2047: 1100 to 1950 us
//   Raw     any train, glitches included; until the next change of the set-point
#pragma once
#include <cstdint>

#include "harness/world/request.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::stand {

class PulseOutput {
 public:
  explicit PulseOutput(std::uint16_t motor) : motor_(motor) {}

  void follow(std::uint16_t v, bool silent, double rate_Hz);
  void set(const request::Pulses& pulses);
  void send(std::int64_t t_ns, io::Batch& sensed);

 private:
  std::uint16_t motor_;
  std::int32_t followed_ = -2;  // a set-point; -1: silence; -2: nothing yet
  io::PulseTrain train_;
  bool fresh_ = false;
};

}  // namespace whirl::stand

// The pilot's radio-control transmitter: sticks and a switch, sent at 50 Hz as rc_channels.
//
//   Channels  1 roll, 2 pitch, 3 thrust, 4 yaw, 5 mode switch, 6 arm switch; 7 to 16 stay centred
//   Start     off; the first request switches it on, with roll, pitch and yaw centred, thrust at its
//             lower stop, the mode switch in position 1 and the arm switch off
//   Off       nothing is sent: what a receiver does then is its failsafe
#pragma once
#include <cstdint>

#include "harness/world/request.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::flight {

class Transmitter {
 public:
  // To the receiver of that board of the run.
  explicit Transmitter(std::uint8_t board = 0);

  void set(const request::Sticks& sticks);
  // What is due at t_ns.
  void step(std::int64_t t_ns, io::Batch& sensed);

 private:
  std::uint8_t board_;
  bool on_ = false;
  io::RcChannels channels_;
  std::int64_t next_ns_ = 0;
};

}  // namespace whirl::flight

// An analog level between two boards: what the follower's DAC puts out stands at the leader's analog pin, in the place of the
// device there.
//
//   Latency   stated by the plan: a change is sampled by the leader that long after the follower has made it, exactly
//   Before    the follower has put anything out: 0 V
//   Left out  the pin's capacitor, settling, noise, and the two boards' supplies, of which each is 3.3 V
#pragma once
#include <deque>
#include <utility>

#include "io_bridges/qemu/board/wire_ends.hpp"
#include "io_bridges/rack/device_type.hpp"

namespace whirl::board {

class LeaderLevel final : public LeaderPort {
 public:
  LeaderLevel(LeaderWire& wire, std::uint8_t port, Nanoseconds latency_ns);

  double volts(Nanoseconds now);  // now: no earlier than that of the call before

 private:
  void edge(const io::WireEdge& edge) override;

  Nanoseconds latency_ns_;
  double level_V_ = 0.0;
  std::deque<std::pair<Nanoseconds, double>> coming_;  // due, level
};

class FollowerLevel final : public FollowerPort {
 public:
  FollowerLevel(FollowerWire& wire, std::uint8_t port);

  void put(double level_V);

 private:
  bool act(const io::WireMessage&, Nanoseconds) override { return false; }  // nothing comes
  io::WireAnswer reply(io::WireAnswer::Clock, Nanoseconds) override { return {}; }

  FollowerWire& wire_;
  std::uint8_t port_;
};

}  // namespace whirl::board

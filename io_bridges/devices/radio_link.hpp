// What a radio-control receiver knows of its transmitter's sticks: late, and until the link is lost.
//
//   In       stick positions as shares of full travel: -1..1, beyond by what the transmitter's extended
//            travel allows; 16 channels, number 1 first
//   Timing   what was sent at t counts from t + latency; nothing new for lost_after: frames are lost;
//            for failsafe_after: failsafe
//   Fault    rc_link_lost: what is sent while it lasts does not arrive
#pragma once
#include <array>
#include <deque>

#include "io_bridges/devices/core/receiver.hpp"
#include "io_bridges/devices/faults.hpp"

namespace whirl::io {

using StickPositions = std::array<double, 16>;
inline constexpr std::size_t kThrustStick = 2;  // channel 3

enum class Failsafe : std::uint8_t { stop, hold, fixed };  // what the receiver puts out then

class RadioLink {
 public:
  struct Params {
    Nanoseconds latency_ns = 22'000'000;  // of the radio: one frame
    Nanoseconds lost_after_ns = core::receiver::kLost_after_ns;
    Nanoseconds failsafe_after_ns = core::receiver::kFailsafe_after_ns;
    Failsafe failsafe = Failsafe::hold;
    double failsafe_thrust = -1.2;  // channel 3 of the fixed positions; the others are centred
    int bus = kAnywhere, device = kAnywhere;  // where faults find it
  };
  enum class State : std::uint8_t { never_heard, up, frame_lost, failsafe };
  struct Output {
    State state = State::never_heard;
    bool silent = false;  // the style is to put out nothing
    StickPositions sticks{};
  };

  RadioLink(const Params& params, FaultBook* faults);  // `faults` may be null

  void on_sticks(const StickPositions& sticks, Nanoseconds now);
  Output at(Nanoseconds now);  // in order of time

 private:
  struct Sent {
    Nanoseconds due_ns = 0;
    StickPositions sticks{};
  };
  Output failsafe(State state) const;

  Params params_;
  FaultBook* faults_;
  std::deque<Sent> on_the_way_;
  Sent newest_;
  bool heard_ = false;
};

}  // namespace whirl::io

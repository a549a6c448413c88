#include "io_bridges/devices/radio_link.hpp"

namespace whirl::io {

RadioLink::RadioLink(const Params& params, FaultBook* faults) : params_(params), faults_(faults) {}

void RadioLink::on_sticks(const StickPositions& sticks, Nanoseconds now) {
  if (apply(faults_, FaultKind::rc_link_lost, params_.bus, params_.device, now) != nullptr) return;
  on_the_way_.push_back({now + params_.latency_ns, sticks});
}

RadioLink::Output RadioLink::at(Nanoseconds now) {
  for (; !on_the_way_.empty() && on_the_way_.front().due_ns <= now; on_the_way_.pop_front()) {
    newest_ = on_the_way_.front();
    heard_ = true;
  }
  if (!heard_) return failsafe(State::never_heard);
  const Nanoseconds silence = now - newest_.due_ns;
  if (silence >= params_.failsafe_after_ns) return failsafe(State::failsafe);
  const bool lost = silence >= params_.lost_after_ns;
  return {lost ? State::frame_lost : State::up, false, newest_.sticks};
}

RadioLink::Output RadioLink::failsafe(State state) const {
  Output out{.state = state};
  switch (params_.failsafe) {
    case Failsafe::stop:
      out.silent = true;
      break;
    case Failsafe::hold:  // nothing to hold before the first frame
      out.sticks = newest_.sticks;
      out.silent = state == State::never_heard;
      break;
    case Failsafe::fixed:
      out.sticks[kThrustStick] = params_.failsafe_thrust;
      break;
  }
  return out;
}

}  // namespace whirl::io

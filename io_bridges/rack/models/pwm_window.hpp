// The current into a bridge, averaged over each PWM period: what the limits on bus current mean.
//
//   Window   one PWM period of the chip, from where an upper switch goes on to where one goes on next: all windows
//            have one length, as near as the chip's clock has its own. Another edge within a period is a commutation's,
//            which hands the pulse to another leg, and begins none
//   No edge  (all off, or on for the whole period): the next window begins a nominal period after the last
//   Anew     where two edges in a row come a period apart at another phase, the PWM has begun anew: that period
//            counts, and windows follow it from there on
//   Valid    edge-aligned PWM of a clock that is within 2 % of its rate. Beyond, windows are a nominal period long at
//            no certain phase. Steps up to half a period
//   Error    none where edges bound a window; a step over a bound without one is split evenly
//   Units    A, C, ns of virtual time
#pragma once
#include <optional>

#include "io_bridges/devices/event_queue.hpp"

namespace whirl::rack {

using io::Nanoseconds;

class PwmWindow {
 public:
  explicit PwmWindow(Nanoseconds period_ns);  // as the chip's clock should make it

  // What has gone into the bridge since the last call, evenly over the time until `now`.
  void flow(double charge_C, Nanoseconds now);
  void upper_switch_on();  // at the time of the last flow()

  // The largest mean of a window that ended since the last call; 0 where none was above it.
  double take_peak_A();

 private:
  struct Mark {
    Nanoseconds at_ns = 0;
    double charge_C = 0.0;  // until then
  };
  bool is_period(Mark from, Mark to) const;
  void close(Mark end);

  Nanoseconds period_ns_, slack_ns_;
  Mark now_, start_;
  std::optional<Mark> due_;   // the window's nominal end, once passed: an edge may still come
  std::optional<Mark> edge_;  // the last one
  double peak_A_ = 0.0;
};

}  // namespace whirl::rack

// How thrusts follow their set-points, and so what the next hold of 20 ms can do.
//
//   Model    a set-point is reached within milliseconds but for two limits: upward by the ESC's current,
//            51 N/s; downward nothing brakes, the rotor coasts: T' = -4.0 T^1.5 (torque as thrust, both as
//            the square of speed)
//   Source   the ESC's response on the stand and in flight steps of 1 to 3 N (rise 51..58 N/s, fall within
//            10 % of the law over 4.4..1.6 N); fixed numbers, one set for all rotors. A copy's rotor has risen by 34 N/s
//            (by its speed) to 40 in flight; to believe 36 to 44 makes steps of 20 degrees swing over by 25 %
//   Left out what the set-point's own thrust map is wrong by, sagging of the battery below the limit of
//            current, mode thrust_by_power's own filter
#pragma once
#include "firmware/control/mixer.hpp"

namespace fw {

class RotorResponse {
 public:
  static constexpr float kHold_s = 0.02f;

  void start(float thrust_N);
  // From now on the rotors go to these.
  void sent(const RotorThrusts& setpoints_N) { setpoints_N_ = setpoints_N; }
  void step(float dt_s);

  // Of each rotor's mean thrust over the next hold.
  ThrustRanges reach() const;
  // The set-points that make these means, which are within reach.
  RotorThrusts setpoints_for(const RotorThrusts& means_N) const;

  const RotorThrusts& thrusts_N() const { return thrusts_N_; }

 private:
  RotorThrusts thrusts_N_{}, setpoints_N_{};
};

}  // namespace fw

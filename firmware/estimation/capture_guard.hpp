// Which poses of the capture system are believed in the air.
//
//   Gate     a pose further from the estimate than half a metre, and a metre more with each second since the last one that
//            was believed, or turned by more than 30 degrees against the gyro's heading, is not used: it stays out
//            until it comes back, or the estimate may have drifted so far
//   Stuck    cameras measure a tenth of a millimetre: a pose that repeats to the last bit is the newest that somebody
//            still has, and not one of now. Some come twice
//   Notices  markers that were swapped, another body taken for this one, a frame that jumps, a pose that stands still
//   Blind    to a frame that creeps: nothing on board tells that from wind
#pragma once
#include <algorithm>

#include "firmware/math.hpp"

namespace fw {

class CaptureGuard {
 public:
  static constexpr float kGate_m = 0.5f, kDrift_mps = 1.0f, kTurned_rad = 0.52f;
  static constexpr unsigned kMostSame = 8;  // 0.2 s at 40 Hz

  // Asked of each pose once. True: it is as those before it.
  bool stuck(const Vector3& p_W_m, float yaw_rad) {
    const bool same = p_W_m == last_W_m_ && yaw_rad == last_yaw_rad_;
    same_ = same ? std::min(same_ + 1, kMostSame) : 0;
    last_W_m_ = p_W_m;
    last_yaw_rad_ = yaw_rad;
    return same_ == kMostSame;
  }
  // By how much it is off the estimate, age_s after the last that was believed.
  static bool plausible(float off_m, float turned_rad, float age_s) {
    return off_m < kGate_m + kDrift_mps * age_s && std::abs(turned_rad) < kTurned_rad;  // nor NaN
  }

 private:
  unsigned same_ = 0;  // as the one before, in a row
  Vector3 last_W_m_ = Vector3::Zero();
  float last_yaw_rad_ = 0.0f;
};

}  // namespace fw

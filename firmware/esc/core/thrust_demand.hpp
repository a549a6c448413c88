// The speed that gives a wanted thrust or power: the static map, corrected by what the air does to the
// rotor now. The speed controller below it has feedforward, anti-windup and current guard.
//
//   Law     T = r CT(w) w^2, P = p CP(w) w^3; r and p are the rotor's thrust and power
//           over those in still air (ThrustEstimator), both 1 where nothing is known
//   Why not an integrator over thrust: r and p move with the inflow ratio only, and the estimator
//           carries them along as the rotor's own speed changes that, so a step of the set-point
//           rises as under the RPM controller
#pragma once
#include <cmath>

#include "firmware/esc/core/calibration.hpp"

namespace fw::esc {

inline float speed_for_thrust_radps(const StaticMap& map, float thrust_N, float ratio) {
  const float T = thrust_N / ratio;
  float w = (-map.a1 + std::sqrt(map.a1 * map.a1 + 4.0f * map.a2 * T)) / (2.0f * map.a2);
  for (int k = 0; k < 3; ++k) {  // Newton; a3 is a small correction
    w -= (map.CT(w) * w * w - T) / ((3.0f * map.a3 * w + 2.0f * map.a2) * w + map.a1);
  }
  return w;
}

inline float speed_for_power_radps(const StaticMap& map, float power_W, float ratio) {
  const float P = power_W / ratio;
  float w = std::cbrt(P / map.q2);
  for (int k = 0; k < 4; ++k) {  // Newton again
    const float slope = (5.0f * map.q4 * w + 4.0f * map.q3) * w + 3.0f * map.q2;
    w -= (map.CP(w) * w * w * w - P) / (slope * w * w);
  }
  return w;
}

}  // namespace fw::esc

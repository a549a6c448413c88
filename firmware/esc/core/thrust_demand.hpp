// The speed that gives a wanted thrust or power: the static map, corrected by what the air does to the
// rotor now. The speed controller below it has feedforward, anti-windup and current guard.
//
//   Law     T = r (a2 w^2 + a1 w), P = p (q2 w^3 + q1 w^2); r and p are the rotor's thrust and power
//           over those in still air (ThrustEstimator), both 1 where nothing is known
//   Why not an integrator over thrust: r and p move with inflow only, not with speed, so a step of the
//           set-point needs no correction at all and rises as under the RPM controller
#pragma once
#include <cmath>

#include "firmware/esc/core/calibration.hpp"

namespace fw::esc {

inline float speed_for_thrust_radps(const StaticMap& map, float thrust_N, float ratio) {
  const float T = thrust_N / ratio;
  return (-map.a1 + std::sqrt(map.a1 * map.a1 + 4.0f * map.a2 * T)) / (2.0f * map.a2);
}

inline float speed_for_power_radps(const StaticMap& map, float power_W, float ratio) {
  const float P = power_W / ratio;
  float w = std::cbrt(P / map.q2);
  for (int k = 0; k < 2; ++k) {  // Newton; q1 is a small correction
    w -= ((map.q2 * w + map.q1) * w * w - P) / ((3.0f * map.q2 * w + 2.0f * map.q1) * w);
  }
  return w;
}

}  // namespace fw::esc

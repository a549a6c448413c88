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

// Newton's way to where `step(w)` is 0: at most two steps a control period from where the last one
// ended, if that is near; else from `guess()`.
template <typename Step, typename Guess>
float solved_radps(float near_radps, Step step, Guess guess) {
  constexpr float kNear = 0.2f,
                  kThere = 1e-3f;  // of the speed; the error is about the square of it
  float w = near_radps;
  int steps = 2;
  const float first = w > 0.0f ? step(w) : w;
  if (w > 0.0f && std::fabs(first) < kNear * w) {
    w -= first;
    if (std::fabs(first) < kThere * w) return w;
    --steps;
  } else {
    w = guess();
    steps = 4;
  }
  for (int k = 0; k < steps; ++k) {
    const float less = step(w);
    w -= less;
    if (std::fabs(less) < kThere * w) break;
  }
  return w;
}

inline float speed_for_thrust_radps(const StaticMap& map, float thrust_N, float ratio,
                                    float near_radps = 0.0f) {
  const float T = thrust_N / ratio;
  const auto step = [&](float w) {
    return (((map.a3 * w + map.a2) * w + map.a1) * w - T) /
           ((3.0f * map.a3 * w + 2.0f * map.a2) * w + map.a1);
  };
  const auto guess = [&] {  // a3 is a small correction
    return (-map.a1 + std::sqrt(map.a1 * map.a1 + 4.0f * map.a2 * T)) / (2.0f * map.a2);
  };
  return solved_radps(near_radps, step, guess);
}

inline float speed_for_power_radps(const StaticMap& map, float power_W, float ratio,
                                   float near_radps = 0.0f) {
  const float P = power_W / ratio;
  const auto step = [&](float w) {
    const float slope = (5.0f * map.q4 * w + 4.0f * map.q3) * w + 3.0f * map.q2;
    const float square = w * w;
    return (map.CP(w) * square * w - P) / (slope * square);
  };
  return solved_radps(near_radps, step, [&] { return std::cbrt(P / map.q2); });
}

}  // namespace fw::esc

#include "firmware/control/rotor_response.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

using config::kThrustMin_N, config::kThrustUsable_N;

constexpr float kUp_Nps = 51.0f;
constexpr float kCoast_psqrtN = 4.0f;

float fall_Nps(float thrust_N) {
  return kCoast_psqrtN * thrust_N * std::sqrt(thrust_N);
}

// A ramp of this rate that ends on the way: the change that gives this mean change over the hold.
float change_for(float mean_change_N, float rate_Nps) {
  const float whole_N = rate_Nps * RotorResponse::kHold_s;
  return whole_N * (1.0f - std::sqrt(std::max(0.0f, 1.0f - 2.0f * mean_change_N / whole_N)));
}

}  // namespace

void RotorResponse::start(float thrust_N) {
  thrusts_N_.fill(thrust_N);
  setpoints_N_.fill(thrust_N);
}

void RotorResponse::step(float dt_s) {
  for (unsigned i = 0; i < 4; ++i) {
    const float now_N = thrusts_N_[i];
    thrusts_N_[i] =
        std::clamp(setpoints_N_[i], now_N - fall_Nps(now_N) * dt_s, now_N + kUp_Nps * dt_s);
  }
}

ThrustRanges RotorResponse::reach() const {
  ThrustRanges ranges;
  for (unsigned i = 0; i < 4; ++i) {
    const float now_N = thrusts_N_[i];
    const float low_N = now_N - 0.5f * kHold_s * fall_Nps(now_N);
    const float high_N = now_N + 0.5f * kHold_s * kUp_Nps;
    ranges[i].low_N = std::clamp(low_N, kThrustMin_N, kThrustUsable_N);
    ranges[i].high_N = std::clamp(high_N, kThrustMin_N, kThrustUsable_N);
  }
  return ranges;
}

RotorThrusts RotorResponse::setpoints_for(const RotorThrusts& means_N) const {
  RotorThrusts setpoints_N;
  for (unsigned i = 0; i < 4; ++i) {
    const float now_N = thrusts_N_[i], change_N = means_N[i] - now_N;
    setpoints_N[i] = change_N > 0.0f ? now_N + change_for(change_N, kUp_Nps)
                                     : now_N - change_for(-change_N, fall_Nps(now_N));
  }
  return setpoints_N;
}

}  // namespace fw

#include "firmware/control/mixer.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

using config::kThrustMin_N, config::kThrustUsable_N;

// The largest share (at most 1) of `part` that keeps base + share * part within the limits.
float share_that_fits(const RotorThrusts& base, const RotorThrusts& part) {
  float share = 1.0f;
  for (unsigned i = 0; i < 4; ++i) {
    const float room = part[i] > 0.0f ? kThrustUsable_N - base[i] : base[i] - kThrustMin_N;
    const float wanted = std::abs(part[i]);
    if (wanted > 1e-6f) share = std::min(share, std::max(room, 0.0f) / wanted);
  }
  return share;
}

void add(RotorThrusts& sum, const RotorThrusts& part, float share) {
  for (unsigned i = 0; i < 4; ++i) sum[i] += share * part[i];
}

}  // namespace

RotorThrusts mix(float thrust_N, const Vector3& tau_B_Nm) {
  const float x = tau_B_Nm.x() / (2.0f * config::kArm_m);
  const float y = tau_B_Nm.y() / (2.0f * config::kArm_m);
  const float z = tau_B_Nm.z() / (4.0f * config::kTorquePerThrust_m);
  const RotorThrusts tilting{y, -x, -y, x}, turning{z, -z, z, -z};
  RotorThrusts thrusts;
  thrusts.fill(std::clamp(0.25f * thrust_N, kThrustMin_N, kThrustUsable_N));
  add(thrusts, tilting, share_that_fits(thrusts, tilting));
  add(thrusts, turning, share_that_fits(thrusts, turning));
  return thrusts;
}

std::uint16_t setpoint_for(float thrust_N) {
  const float span = (thrust_N - kThrustMin_N) / (config::kThrustMax_N - kThrustMin_N);
  return static_cast<std::uint16_t>(1.5f + 2046.0f * std::clamp(span, 0.0f, 1.0f));
}

}  // namespace fw

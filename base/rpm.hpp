// Revolutions per minute, for the edges where people and protocols write them; inside, speed is rad/s.
#pragma once
#include <numbers>

namespace whirl {

inline constexpr double kRpm_per_radps = 30.0 / std::numbers::pi;

constexpr double rpm_of(double speed_radps) {
  return speed_radps * kRpm_per_radps;
}
constexpr double radps_of(double speed_rpm) {
  return speed_rpm / kRpm_per_radps;
}

// 60 / (2 pi Kv): what turns a data sheet's Kv into the torque constant (N m/A, or V s/rad).
constexpr double torque_constant_NmpA_of(double kv_rpm_per_V) {
  return 30.0 / (std::numbers::pi * kv_rpm_per_V);
}

}  // namespace whirl

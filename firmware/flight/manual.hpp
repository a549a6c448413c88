// From sticks to what is flown in the two manual modes.
//
//   Attitude  roll and pitch to +-35 deg, yaw rate to 120 deg/s, throttle to the collective with hover at
//             its middle
//   Velocity  pitch and roll to a horizontal velocity along the heading, throttle to a climb rate with
//             height held in a dead zone of +-10 % about its middle, yaw to a rate of turn
//   Ground    throttle above the middle lifts off. In velocity mode a descent below touch-down height is
//             a landing, which ends with idling motors; in attitude mode throttle low and standing does.
//             Motors are stopped by the arm switch with throttle low, and by nothing else
#pragma once
#include "firmware/config/vehicle.hpp"
#include "firmware/control/attitude_reference.hpp"
#include "firmware/flight/pilot.hpp"
#include "firmware/math.hpp"

namespace fw::manual {

inline constexpr float kThrottleDeadZone = 0.1f;  // about the middle, share of the range
inline constexpr float kTurn_radps = 0.6f;        // the reference's own limit
inline constexpr float kYawLead_s = 0.1f;         // the reference is drawn along by that much
inline constexpr float kGround_m = 0.1f, kStanding_mps = 0.12f, kSettled_s = 0.5f;

struct VelocityDemand {
  Vector3 v_W_mps = Vector3::Zero();
  float climb_mps = 0.0f, yaw_rate_radps = 0.0f;
};

// A throttle that means flight.
inline bool lifts(const PilotDemand& sticks) {
  return sticks.throttle > 0.5f + kThrottleDeadZone;
}

inline AttitudeDemand attitude_of(const PilotDemand& sticks) {
  return {.roll_rad = AttitudeReference::kTiltLimit_rad * sticks.roll,
          .pitch_rad = AttitudeReference::kTiltLimit_rad * sticks.pitch,
          .yaw_rate_radps = AttitudeReference::kYawRateLimit_radps * sticks.yaw};
}

inline VelocityDemand velocity_of(const PilotDemand& sticks, float yaw_rad) {
  VelocityDemand out;
  const float ahead = -config::kSpeedLimit_mps * sticks.pitch;  // nose down is ahead
  const float right = config::kSpeedLimit_mps * sticks.roll;
  const float c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  out.v_W_mps = {c * ahead - s * right, s * ahead + c * right, 0.0f};
  const float off = sticks.throttle - 0.5f;
  const float moved = std::max(std::abs(off) - kThrottleDeadZone, 0.0f);
  const float climb = config::kClimbLimit_mps * moved / (0.5f - kThrottleDeadZone);
  out.climb_mps = off < 0.0f ? -climb : climb;
  out.yaw_rate_radps = kTurn_radps * sticks.yaw;
  return out;
}

}  // namespace fw::manual

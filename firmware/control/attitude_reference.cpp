#include "firmware/control/attitude_reference.hpp"

#include <algorithm>

namespace fw {
namespace {

constexpr float kStep_s = 0.005f;
// What the hold's mean comes before the profile, beyond what rotor_response.hpp knows of the ESC.
constexpr float kEscLag_s = -0.002f;
// The rotors change by 0.7 to 1 N upward and 0.3 N downward in 20 ms about hover, by 0.4 N and more once their pair is
// lifted (mixer.hpp), which is 1300 rad/s^3 and more while a fast one slows down. Means of 100, 45 and 60 ms make of a step
// four pieces of jerk, and of 20 degrees 1300 rad/s^3, with its 10 to 90 % in 96 ms, of which the loop, which
// swings over a little, takes off some. From 20 degrees on it runs at the limit of speed (97 ms): faster
// would be overshoot on a copy whose braking rotor is slow.
// Lengths, lag, lift and the step at which a demand is taken belong together. They were chosen by a model of one pair of
// rotors in this loop (rates by ESC and coasting, hold, delays), fitted to the steps of six copies, for the worst rise
// and overshoot over rotors of unequal rates, thrusts and inertias; then judged on ten copies that were not looked at.
constexpr float kSpeedLimit_radps = 3.4f;
// Torque of yaw is small: 0.09 N m about hover, 3.9 rad/s^2.
constexpr float kYawAcceleration_radps2 = 2.5f;
constexpr float kHeading_ps = 1.5f;  // of the heading that is asked for

float towards(float from, float to, float most) {
  return from + std::clamp(to - from, -most, most);
}

// Of the angles' rates: along the body's axes.
Vector3 body_rates(float roll, float pitch, const Vector3& rates) {
  const float sr = std::sin(roll), cr = std::cos(roll), sp = std::sin(pitch), cp = std::cos(pitch);
  return {rates.x() - sp * rates.z(), cr * rates.y() + sr * cp * rates.z(),
          -sr * rates.y() + cr * cp * rates.z()};
}

}  // namespace

AttitudeDemand demand_of(const Quaternion& q_WB, float yaw_rate_radps) {
  const Matrix3 R_WB = q_WB.toRotationMatrix();
  return {std::atan2(R_WB(2, 1), R_WB(2, 2)), -std::asin(std::clamp(R_WB(2, 0), -1.0f, 1.0f)),
          yaw_rate_radps, yaw_of(q_WB)};
}

void AttitudeReference::Angle::start(float value_rad) {
  limited_rad = rad = value_rad;
  rate_radps = 0.0f;
  first.fill(value_rad);
  second.fill(value_rad);
  third.fill(value_rad);
}

void AttitudeReference::Angle::step(float demand_rad) {
  const float demand = std::clamp(demand_rad, -kTiltLimit_rad, kTiltLimit_rad);
  limited_rad = towards(limited_rad, first.step(demand), kSpeedLimit_radps * kStep_s);
  const float before_rad = rad;
  rad = third.step(second.step(limited_rad));
  rate_radps = (rad - before_rad) / kStep_s;
}

void AttitudeReference::start(const Quaternion& q_WB) {
  const AttitudeDemand there = demand_of(q_WB, 0.0f);
  demand_ = there;
  roll_.start(there.roll_rad);
  pitch_.start(there.pitch_rad);
  yaw_rad_ = *there.yaw_rad;
  limited_yaw_rate_radps_ = 0.0f;
  mean_yaw_rate_.fill(0.0f);
  points_.fill({.q_WB = from_euler(roll_.rad, pitch_.rad, yaw_rad_)});
}

void AttitudeReference::step(const AttitudeDemand& demand, bool takes_it) {
  if (takes_it) demand_ = demand;
  roll_.step(demand_.roll_rad);
  pitch_.step(demand_.pitch_rad);
  const float back = demand_.yaw_rad ? kHeading_ps * wrap_pi(*demand_.yaw_rad - yaw_rad_) : 0.0f;
  const float yaw_rate =
      std::clamp(demand_.yaw_rate_radps + back, -kYawRateLimit_radps, kYawRateLimit_radps);
  limited_yaw_rate_radps_ =
      towards(limited_yaw_rate_radps_, yaw_rate, kYawAcceleration_radps2 * kStep_s);
  const Vector3 rates(roll_.rate_radps, pitch_.rate_radps,
                      mean_yaw_rate_.step(limited_yaw_rate_radps_));
  yaw_rad_ = wrap_pi(yaw_rad_ + rates.z() * kStep_s);
  std::copy_backward(points_.begin(), points_.end() - 1, points_.end());
  Point& now = points_.front();
  now.q_WB = from_euler(roll_.rad, pitch_.rad, yaw_rad_);
  now.w_B_radps = body_rates(roll_.rad, pitch_.rad, rates);
  now.alpha_B_radps2 = (now.w_B_radps - points_[1].w_B_radps) / kStep_s;
}

Vector3 AttitudeReference::mean_alpha(std::size_t newest) const {
  constexpr float kHold_s = static_cast<float>(kLead) * kStep_s;
  const Point &to = points_[newest], &from = points_[newest + kLead];
  return (to.w_B_radps - from.w_B_radps + kEscLag_s * (to.alpha_B_radps2 - from.alpha_B_radps2)) /
         kHold_s;
}

void AttitudeReference::put(ThrustAndAttitude& wanted) const {
  const Point& present = points_.back();
  wanted.q_WB = present.q_WB;
  wanted.w_B_radps = present.w_B_radps;
  wanted.w_dot_B_radps2 = mean_alpha(kLead);
  wanted.next_w_dot_B_radps2 = mean_alpha(0);
}

}  // namespace fw

#include "firmware/estimation/inertial_filter.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

constexpr float kG = config::kGravity_mps2;
constexpr float kStep_s = 0.005f;
constexpr float kVelocity_ps = 2.0f;
constexpr float kTilt = 1.0f / (kG * kG), kScale = 0.7f / (kG * kG), kGyroBias = 0.015f / (kG * kG);
constexpr float kAccelBias_ps = 0.002f, kBiasCoupling_ps = 0.05f;
constexpr float kHeading_ps = 2.0f;
constexpr float kVelocityCoupling_ps = 0.1f, kAttitudeCoupling_ps = 0.1f;
constexpr float kWind_ps = 0.5f;
constexpr float kLongest_s = 0.25f;  // after a gap the old error is not its length
constexpr float kSmallestScale = 0.3f;
// Of the innovation that the gyro's bias learns from: a wrong start is no bias.
constexpr float kMostForBias = 2.0f;

}  // namespace

void InertialFilter::start(const Quaternion& q_WB, const Vector3& v_W_mps, float scale) {
  q_WB_ = q_WB;
  v_W_mps_ = v_W_mps;
  scale_ = scale;
  wind_W_mps_.setZero();
  gyro_bias_B_radps_.setZero();
  accel_bias_B_mps2_.setZero();
  history_.fill(v_W_mps);
}

void InertialFilter::resume(const Quaternion& q_WB, const Vector3& v_W_mps) {
  q_WB_ = q_WB;
  v_W_mps_ = v_W_mps;
  history_.fill(v_W_mps);
}

void InertialFilter::predict(const Vector3& w_B_radps, const Vector3& a_B_mps2,
                             const FromBodyFilter& other, float dt_s) {
  const Vector3 through_air = v_W_mps_ - wind_W_mps_ - other.v_AB_W_mps;
  const Vector3 v_dot = q_WB_ * (a_B_mps2 - accel_bias_B_mps2_) + scale_ * kG * Vector3::UnitZ() -
                        kVelocityCoupling_ps * through_air;
  const Vector3 apart_B = antisymmetric_part(q_WB_.conjugate() * other.q_WB);
  v_W_mps_ += dt_s * v_dot;
  if (!other.hold_wind) wind_W_mps_ += dt_s * kWind_ps * through_air;
  q_WB_ = turned(q_WB_, w_B_radps - gyro_bias_B_radps_ + kAttitudeCoupling_ps * apart_B, dt_s);
  Vector3 bias_dot = -kBiasCoupling_ps * (accel_bias_B_mps2_ - other.accel_bias_B_mps2);
  bias_dot.z() = 0.0f;
  accel_bias_B_mps2_ += dt_s * bias_dot;
  newest_ = (newest_ + 1) % kHistory;
  history_[newest_] = v_W_mps_;
}

const Vector3& InertialFilter::v_ago(float delay_s) const {
  const auto steps =
      static_cast<unsigned>(std::lround(std::min(delay_s, kLongestDelay_s) / kStep_s));
  return history_[(newest_ + kHistory - steps) % kHistory];
}

void InertialFilter::correct(const Vector3& v_WB_W_mps, float delay_s, float since_last_s) {
  const float dt_s = std::min(since_last_s, kLongest_s);
  const Vector3 error = v_ago(delay_s) - v_WB_W_mps;
  const Vector3 tilt_W = kG / scale_ * error.cross(Vector3::UnitZ());
  const Quaternion to_B = q_WB_.conjugate();
  Vector3 bias = dt_s * kAccelBias_ps * kVelocity_ps * (to_B * error);
  bias.z() = 0.0f;
  accel_bias_B_mps2_ += bias;
  gyro_bias_B_radps_ += dt_s * kGyroBias * (to_B * clamp_norm(tilt_W, kMostForBias));
  v_W_mps_ -= dt_s * kVelocity_ps * error;
  scale_ = std::max(scale_ - dt_s * kScale * kG * error.z(), kSmallestScale);
  q_WB_ = turned(q_WB_, to_B * (-kTilt * tilt_W), dt_s);
}

void InertialFilter::correct_heading(float yaw_rad, float since_last_s) {
  const float share = std::min(kHeading_ps * std::min(since_last_s, kLongest_s), 1.0f);
  const float half = 0.5f * share * wrap_pi(yaw_rad - yaw_of(q_WB_));
  q_WB_ = (Quaternion(std::cos(half), 0.0f, 0.0f, std::sin(half)) * q_WB_).normalized();
}

}  // namespace fw

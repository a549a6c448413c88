#include "firmware/estimation/body_filter.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

constexpr float kG = config::kGravity_mps2;
constexpr float kVelocity_ps = 2.0f;
constexpr float kTilt = 1.0f / (kG * kG), kScale = 0.7f / (kG * kG), kGyroBias = 0.015f / (kG * kG);
constexpr float kAccelBias_ps = 0.002f;
constexpr float kHeading_ps = 0.5f;
constexpr float kVelocityCoupling_ps = 0.5f, kAttitudeCoupling_ps = 0.5f, kBiasCoupling_ps = 0.05f;
constexpr float kSmallestScale = 0.3f;
// Of the innovation that the gyro's bias learns from: a wrong start is no bias.
constexpr float kMostForBias = 2.0f;

}  // namespace

void BodyFilter::start(const Quaternion& q_WB, float scale) {
  q_WB_ = q_WB;
  scale_ = scale;
  v_B_mps_.setZero();
  gyro_bias_B_radps_.setZero();
  accel_bias_B_mps2_.setZero();
}

void BodyFilter::step(const Vector3& w_B_radps, const Vector3& a_B_mps2,
                      const Vector3& v_measured_B_mps, const FromInertialFilter& other,
                      float dt_s) {
  const Vector3 w = w_B_radps - gyro_bias_B_radps_;
  const Vector3 error = v_B_mps_ - v_measured_B_mps;
  const Vector3 down_B = q_WB_.conjugate() * Vector3::UnitZ();
  Vector3 v_dot = -w.cross(v_B_mps_) + kG * scale_ * down_B + a_B_mps2 - accel_bias_B_mps2_ -
                  kVelocity_ps * error;
  // In B: R' (R V~ x e3) = V~ x R'e3.
  const Vector3 tilt_B = kG / scale_ * error.cross(down_B);
  Vector3 turn_B = w - kTilt * tilt_B;
  Vector3 bias_dot = kAccelBias_ps * kVelocity_ps * error;
  if (other.valid) {
    const Quaternion to_B = q_WB_.conjugate();
    v_dot -= kVelocityCoupling_ps * (v_B_mps_ - to_B * other.v_through_air_W_mps);
    turn_B += kAttitudeCoupling_ps * antisymmetric_part(to_B * other.q_WB);
    bias_dot -= kBiasCoupling_ps * (accel_bias_B_mps2_ - other.accel_bias_B_mps2);
  }
  bias_dot.z() = 0.0f;
  v_B_mps_ += dt_s * v_dot;
  q_WB_ = turned(q_WB_, turn_B, dt_s);
  scale_ = std::max(scale_ - dt_s * kScale * kG * error.dot(down_B), kSmallestScale);
  gyro_bias_B_radps_ += dt_s * kGyroBias * clamp_norm(tilt_B, kMostForBias);
  accel_bias_B_mps2_ += dt_s * bias_dot;
}

void BodyFilter::correct_heading(const Vector3& field_B, float declination_rad,
                                 float since_last_s) {
  constexpr float kLongest_s = 0.1f;
  const Vector3 field_W = q_WB_ * field_B;
  const float level = field_W.head<2>().norm();
  if (!(level > 0.0f)) return;
  const float sine =
      (std::cos(declination_rad) * field_W.y() - std::sin(declination_rad) * field_W.x()) / level;
  const float turn = -kHeading_ps * std::min(since_last_s, kLongest_s) * sine;
  q_WB_ = (Quaternion(1.0f, 0.0f, 0.0f, 0.5f * turn) * q_WB_).normalized();
}

}  // namespace fw

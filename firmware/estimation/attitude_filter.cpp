#include "firmware/estimation/attitude_filter.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {
constexpr float kBiasPerAngle = 0.05f;  // kI / kP: ten times slower than the slowest use of kP
}

void AttitudeFilter::start(const Vector3& a_B_mps2, float yaw_rad) {
  const Vector3 down_B = -a_B_mps2;
  const float roll = std::atan2(down_B.y(), down_B.z());
  const float pitch = std::atan2(-down_B.x(), down_B.tail<2>().norm());
  q_WB_ = from_euler(roll, pitch, yaw_rad);
}

void AttitudeFilter::update(const Vector3& w_B_radps, const Vector3& a_B_mps2, float dt_s,
                            float accel_gain_radps) {
  const float norm = a_B_mps2.norm();
  Vector3 w_mes = Vector3::Zero();
  if (std::abs(norm - config::kGravity_mps2) < 0.2f * config::kGravity_mps2) {
    const Vector3 down_measured = -a_B_mps2 / norm;
    const Vector3 down_estimated = q_WB_.conjugate() * Vector3::UnitZ();
    w_mes = accel_gain_radps * down_measured.cross(down_estimated);
  }
  w_B_radps_ = w_B_radps - bias_B_radps_;
  q_WB_ = turned(q_WB_, w_B_radps_ + w_mes, dt_s);
  bias_B_radps_ -= kBiasPerAngle * dt_s * w_mes;
}

void AttitudeFilter::correct_heading(float yaw_rad, float share) {
  const float half = 0.5f * share * wrap_pi(yaw_rad - yaw_of(q_WB_));
  q_WB_ = (Quaternion(std::cos(half), 0.0f, 0.0f, std::sin(half)) * q_WB_).normalized();
}

}  // namespace fw

// Float vectors and rotations of the firmware, fixed in size.
//
//   W  world, north-east-down       B  body, forward-right-down
//   q_WB, R_WB turn B-components into W-components; quaternions are Hamilton, scalar first
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace fw {

using Vector3 = Eigen::Vector3f;
using Matrix3 = Eigen::Matrix3f;
using Quaternion = Eigen::Quaternionf;

inline constexpr float kPi = 3.14159265358979f;

inline float wrap_pi(float angle_rad) {
  if (std::abs(angle_rad) <= kPi) return angle_rad;
  return std::remainder(angle_rad, 2.0f * kPi);  // in bounded time, whatever a message says
}

inline Vector3 clamp_each(const Vector3& v, const Vector3& limit) {
  return v.cwiseMin(limit).cwiseMax(-limit);
}

template <int kSize>
Eigen::Matrix<float, kSize, 1> clamp_norm(const Eigen::Matrix<float, kSize, 1>& v, float norm) {
  const float is = v.norm();
  if (is > norm) return norm / is * v;
  return v;
}

inline float yaw_of(const Quaternion& q_WB) {
  return std::atan2(2.0f * (q_WB.w() * q_WB.z() + q_WB.x() * q_WB.y()),
                    1.0f - 2.0f * (q_WB.y() * q_WB.y() + q_WB.z() * q_WB.z()));
}

// From roll, pitch, yaw in the order yaw, pitch, roll.
inline Quaternion from_euler(float roll_rad, float pitch_rad, float yaw_rad) {
  const float cr = std::cos(0.5f * roll_rad), sr = std::sin(0.5f * roll_rad);
  const float cp = std::cos(0.5f * pitch_rad), sp = std::sin(0.5f * pitch_rad);
  const float cy = std::cos(0.5f * yaw_rad), sy = std::sin(0.5f * yaw_rad);
  return {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
          cr * cp * sy - sr * sp * cy};
}

// The rotation after turning at w_B for dt, exact for a constant rate to the third order.
inline Quaternion turned(const Quaternion& q_WB, const Vector3& w_B_radps, float dt_s) {
  const Vector3 half = 0.5f * dt_s * w_B_radps;
  const Quaternion step(1.0f - 0.5f * half.squaredNorm(), half.x(), half.y(), half.z());
  return (q_WB * step).normalized();
}

// Of the rotation that q stands for, R: the vector of (R - R')/2, thus its axis times the sine of its
// angle, whatever the sign of q.
inline Vector3 antisymmetric_part(const Quaternion& q) {
  return 2.0f * q.w() * q.vec();
}

// Cosine of the angle between the body's z axis and down.
inline float tilt_cosine(const Quaternion& q_WB) {
  return 1.0f - 2.0f * (q_WB.x() * q_WB.x() + q_WB.y() * q_WB.y());
}

}  // namespace fw

#include "firmware/control/desired_attitude.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

// What turns gamma by its derivative: gamma x gamma'.
Vector3 turning(const Vector3& gamma, const Vector3& change_W, float force) {
  return gamma.cross(change_W) / force;
}

Matrix3 facing(const Vector3& gamma, float yaw_rad) {
  const Vector3 heading(std::cos(yaw_rad), std::sin(yaw_rad), 0.0f);
  const Vector3 nu = gamma.cross(heading).normalized();
  Matrix3 R_WB;
  R_WB << nu.cross(gamma), nu, gamma;
  return R_WB;
}

}  // namespace

std::optional<Quaternion> without_heading(float x, float y) {
  const float level = 1.0f - (x * x + y * y);
  if (!(level >= 0.0f)) return std::nullopt;
  const float q0 = std::sqrt(0.5f * (1.0f + std::sqrt(level)));
  return Quaternion(q0, -y / (2.0f * q0), x / (2.0f * q0), 0.0f);
}

ThrustAndAttitude resolve(WantedForce wanted, const Quaternion& q_WB,
                          std::optional<float> yaw_rad) {
  Vector3& f_W = wanted.f_W_mps2;
  f_W.z() = std::max(f_W.z(), 0.2f * config::kGravity_mps2);
  const float sideways = f_W.head<2>().norm();
  const float most = config::kTiltLimit_tan * f_W.z();
  const bool limited = sideways > most;
  if (limited) f_W.head<2>() *= most / sideways;
  const float force = f_W.norm();
  const Vector3 gamma = f_W / force;
  const Matrix3 R_WB =
      yaw_rad ? facing(gamma, *yaw_rad)
              : without_heading(gamma.x(), gamma.y()).value_or(q_WB).toRotationMatrix();
  ThrustAndAttitude out;
  const float along = f_W.dot(q_WB * Vector3::UnitZ());
  out.thrust_N = config::kMass_kg * std::max(along, 0.0f);
  out.q_WB = Quaternion(R_WB);
  if (limited) return out;  // at the limit it does not follow the trajectory
  out.w_B_radps = R_WB.transpose() * turning(gamma, wanted.jerk_W_mps3, force);
  out.w_dot_B_radps2 = R_WB.transpose() * turning(gamma, wanted.snap_W_mps4, force);
  return out;
}

}  // namespace fw

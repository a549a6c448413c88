#include "firmware/control/position_controller.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

using config::kGravity_mps2, config::kMass_kg;

// f: the force T R e3 wanted, per mass, in W.
ThrustAndAttitude resolve(Vector3 f_W_mps2, const Quaternion& q_WB, float yaw_rad) {
  f_W_mps2.z() = std::max(f_W_mps2.z(), 0.2f * kGravity_mps2);  // never upside down
  const float sideways = f_W_mps2.head<2>().norm();
  const float most = config::kTiltLimit_tan * f_W_mps2.z();
  if (sideways > most) f_W_mps2.head<2>() *= most / sideways;
  const Vector3 gamma = f_W_mps2.normalized();
  const Vector3 heading(std::cos(yaw_rad), std::sin(yaw_rad), 0.0f);
  const Vector3 nu = gamma.cross(heading).normalized();
  Matrix3 R_WB;
  R_WB << nu.cross(gamma), nu, gamma;
  // Only the part along the present axis: while still turning, the rest would push elsewhere.
  const float along = f_W_mps2.dot(q_WB * Vector3::UnitZ());
  return {kMass_kg * std::max(along, 0.0f), Quaternion(R_WB)};
}

}  // namespace

ThrustAndAttitude PositionController::step(const Vector3& p_WB_W_m, const Vector3& v_WB_W_mps,
                                           const Quaternion& q_WB, const Reference& reference,
                                           float lift, float dt_s, bool integrate) {
  const Vector3 kp(config::kPositionGain_ps2), kd(config::kVelocityGain_ps);
  const Vector3 p_error = p_WB_W_m - reference.p_W_m();
  const Vector3 v_error = v_WB_W_mps - reference.v_W_mps();
  if (integrate) {
    const Vector3 ki(config::kPositionIntegral_ps3), limit(config::kIntegralLimit_mps2);
    integral_W_mps2_ = clamp_each(integral_W_mps2_ + dt_s * ki.cwiseProduct(p_error), limit);
  }
  Vector3 f_W =
      kp.cwiseProduct(p_error) + kd.cwiseProduct(v_error) + integral_W_mps2_ - reference.a_W_mps2();
  f_W.head<2>() -= config::kDrag_spm * kGravity_mps2 * reference.v_W_mps().head<2>();
  f_W.z() += lift * kGravity_mps2;
  return resolve(f_W, q_WB, reference.yaw_rad());
}

ThrustAndAttitude PositionController::sink(float speed_mps, const Vector3& v_WB_W_mps,
                                           const Quaternion& q_WB, float yaw_rad,
                                           float lift) const {
  Vector3 f_W = integral_W_mps2_;
  const float v_error = std::clamp(v_WB_W_mps.z() - speed_mps, -0.6f, 0.6f);
  f_W.z() += lift * kGravity_mps2 + config::kVelocityGain_ps[2] * v_error;
  return resolve(f_W, q_WB, yaw_rad);
}

float PositionController::hover_thrust_N() const {
  return kMass_kg * (kGravity_mps2 + integral_W_mps2_.z());
}

}  // namespace fw

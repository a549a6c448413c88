#include "firmware/control/position_controller.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {
using config::kGravity_mps2, config::kMass_kg;
}

Vector3 PositionController::force(const Vector3& p_WB_W_m, const Vector3& v_WB_W_mps,
                                  const Reference& reference, float lift) const {
  const Vector3 kp(config::kPositionGain_ps2), kd(config::kVelocityGain_ps);
  const Vector3 p_error = p_WB_W_m - reference.p_W_m();
  const Vector3 v_error = v_WB_W_mps - reference.v_W_mps();
  Vector3 f_W =
      kp.cwiseProduct(p_error) + kd.cwiseProduct(v_error) + integral_W_mps2_ - reference.a_W_mps2();
  f_W.head<2>() -= drag_ps_ * reference.v_W_mps().head<2>();
  f_W.z() += lift * kGravity_mps2;
  return f_W;
}

void PositionController::integrate(const Vector3& p_error_W_m, float dt_s) {
  const Vector3 ki(config::kPositionIntegral_ps3), limit(config::kIntegralLimit_mps2);
  integral_W_mps2_ = clamp_each(integral_W_mps2_ + dt_s * ki.cwiseProduct(p_error_W_m), limit);
}

ThrustAndAttitude PositionController::step(const Vector3& p_WB_W_m, const Vector3& v_WB_W_mps,
                                           const Quaternion& q_WB, const Reference& reference,
                                           float lift, float dt_s, bool integrating) {
  if (integrating) integrate(p_WB_W_m - reference.p_W_m(), dt_s);
  WantedForce wanted{.f_W_mps2 = force(p_WB_W_m, v_WB_W_mps, reference, lift)};
  if (reference.tracking()) {  // what is shaped by steps of acceleration has no jerk to follow
    const Vector3 drag = drag_ps_ * Vector3(1.0f, 1.0f, 0.0f);
    wanted.jerk_W_mps3 = -reference.jerk_W_mps3() - drag.cwiseProduct(reference.a_W_mps2());
    wanted.snap_W_mps4 = -drag.cwiseProduct(reference.jerk_W_mps3());
  }
  ThrustAndAttitude out = resolve(wanted, q_WB, heading(reference.yaw_rad()));
  out.v_B_mps = out.q_WB.conjugate() * reference.v_W_mps();
  return out;
}

float PositionController::height_force(const Vector3& p_WB_W_m, const Vector3& v_WB_W_mps,
                                       const Reference& reference, float lift, float dt_s,
                                       bool integrating) {
  const float error = p_WB_W_m.z() - reference.p_W_m().z();
  if (integrating) integrate({0.0f, 0.0f, error}, dt_s);
  return force(p_WB_W_m, v_WB_W_mps, reference, lift).z();
}

ThrustAndAttitude PositionController::sink(float speed_mps, float sinking_mps,
                                           const Quaternion& q_WB, float yaw_rad,
                                           float lift) const {
  Vector3 f_W = integral_W_mps2_;
  f_W.head<2>() *= lift;  // who carries less leans no further: on its feet it would rock
  const float v_error = std::clamp(sinking_mps - speed_mps, -0.6f, 0.6f);
  f_W.z() += lift * kGravity_mps2 + config::kVelocityGain_ps[2] * v_error;
  return resolve({.f_W_mps2 = f_W}, q_WB, heading(yaw_rad));
}

float PositionController::hover_thrust_N() const {
  return kMass_kg * (kGravity_mps2 + integral_W_mps2_.z());
}

}  // namespace fw

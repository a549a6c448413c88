#include "firmware/control/attitude_controller.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {

Vector3 AttitudeController::torque(const Quaternion& q_WB, const Vector3& w_WB_B_radps,
                                   const ThrustAndAttitude& wanted, float dt_s, bool trim) {
  const Vector3 rate_gain(config::kRateGain_Nms);
  const Vector3 angle_over_rate(config::kAngleOverRate_radps);
  const Vector3 inertia(config::kInertia_kgm2);
  Quaternion q_error = wanted.q_WB.conjugate() * q_WB;
  if (q_error.w() < 0.0f) q_error.coeffs() = -q_error.coeffs();  // the short way round
  const Vector3 angle = 2.0f * q_error.vec();
  if (trim) {
    const Vector3 gain(config::kAngleIntegral_Nmps), limit(config::kAngleIntegralLimit_Nm);
    trim_B_Nm_ = clamp_each(trim_B_Nm_ - dt_s * gain.cwiseProduct(angle), limit);
  }
  const Vector3 spin_B = w_WB_B_radps.cross(inertia.cwiseProduct(w_WB_B_radps));
  const Quaternion to_B = q_error.conjugate();
  const Vector3 w_error = w_WB_B_radps - to_B * wanted.w_B_radps;
  const Vector3 drag_B_N = -drag_spm_ * wanted.thrust_N * wanted.v_B_mps;
  const Vector3 drag_B_Nm(config::kRotorHeight_m * drag_B_N.y(),
                          -config::kRotorHeight_m * drag_B_N.x(), 0.0f);
  return inertia.cwiseProduct(to_B * wanted.w_dot_B_radps2) + spin_B - drag_B_Nm + trim_B_Nm_ -
         rate_gain.cwiseProduct(w_error + angle_over_rate.cwiseProduct(angle));
}

}  // namespace fw

#include "firmware/control/attitude_controller.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {

Vector3 AttitudeController::torque(const Quaternion& q_WB, const Vector3& w_WB_B_radps,
                                   const Quaternion& q_WB_desired, float dt_s, bool trim) {
  const Vector3 rate_gain(config::kRateGain_Nms);
  const Vector3 angle_over_rate(config::kAngleOverRate_radps);
  const Vector3 inertia(config::kInertia_kgm2);
  Quaternion q_error = q_WB_desired.conjugate() * q_WB;
  if (q_error.w() < 0.0f) q_error.coeffs() = -q_error.coeffs();  // the short way round
  const Vector3 angle = 2.0f * q_error.vec();
  if (trim) {
    const Vector3 gain(config::kAngleIntegral_Nmps), limit(config::kAngleIntegralLimit_Nm);
    trim_B_Nm_ = clamp_each(trim_B_Nm_ - dt_s * gain.cwiseProduct(angle), limit);
  }
  const Vector3 spin_B = w_WB_B_radps.cross(inertia.cwiseProduct(w_WB_B_radps));
  return spin_B + trim_B_Nm_ -
         rate_gain.cwiseProduct(w_WB_B_radps + angle_over_rate.cwiseProduct(angle));
}

}  // namespace fw

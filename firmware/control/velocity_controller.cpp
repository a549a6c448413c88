#include "firmware/control/velocity_controller.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

constexpr float kVelocity_ps = 2.8f, kIntegral_ps2 = 1.2f, kForget_ps = 0.05f;
constexpr float kMost_mps = 0.6f;  // of what goes into the integral

}  // namespace

ThrustAndAttitude VelocityController::step(const Vector3& v_WB_W_mps, const Quaternion& q_WB,
                                           const Reference& reference, float f_height_mps2,
                                           float dt_s) {
  const Eigen::Vector2f error = (v_WB_W_mps - reference.v_W_mps()).head<2>();
  const Eigen::Vector2f into =
      clamp_norm<2>(error + kForget_ps / kIntegral_ps2 * delta_W_mps2_, kMost_mps);
  delta_W_mps2_ += dt_s * (kIntegral_ps2 * into - kForget_ps * delta_W_mps2_);
  const Eigen::Vector2f level = kVelocity_ps * error + delta_W_mps2_ -
                                drag_ps_ * reference.v_W_mps().head<2>() -
                                reference.a_W_mps2().head<2>();
  return resolve({{level.x(), level.y(), f_height_mps2}}, q_WB, reference.yaw_rad());
}

}  // namespace fw

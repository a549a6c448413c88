// Thrust and attitude that hold a horizontal velocity, and a height.
//
//   Source  [Bangura 2017, 6.5.2]: m g Rd'e3 = Td e3 + Td c Vd + m W x Vd - m Kv V~ - m delta + m Vd',
//           here turned into W, where W x Vd is no more; delta' = -Kd delta + Ki Sat(V~ + Kd/Ki delta)
//   Height  as the position controller holds it
#pragma once
#include "firmware/config/vehicle.hpp"
#include "firmware/control/desired_attitude.hpp"
#include "firmware/control/reference.hpp"

namespace fw {

class VelocityController {
 public:
  void reset() { delta_W_mps2_.setZero(); }
  void set_drag(float drag_spm) { drag_ps_ = drag_spm * config::kGravity_mps2; }
  // f_height: the vertical force per mass of who holds the height.
  ThrustAndAttitude step(const Vector3& v_WB_W_mps, const Quaternion& q_WB,
                         const Reference& reference, float f_height_mps2, float dt_s);

 private:
  Eigen::Vector2f delta_W_mps2_ = Eigen::Vector2f::Zero();
  float drag_ps_ = config::kDrag_spm * config::kGravity_mps2;  // as the position controller's
};

}  // namespace fw

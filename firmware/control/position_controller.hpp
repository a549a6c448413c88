// Thrust and attitude from position and velocity errors.
//
//   Source  [Bangura 2017, 6.5.1]: Td Rd e3 = m g e3 - m vd' - c T vd + m (Kp p~ + Kd v~ + integral);
//           errors actual minus desired; its derivatives, along the trajectory, feed the attitude
//   Limits  the integral's; the attitude's are those of desired_attitude.hpp
#pragma once
#include "firmware/config/vehicle.hpp"
#include "firmware/control/desired_attitude.hpp"
#include "firmware/control/reference.hpp"
#include "firmware/math.hpp"

namespace fw {

class PositionController {
 public:
  void reset() { integral_W_mps2_.setZero(); }
  void set_drag(float drag_spm) { drag_ps_ = drag_spm * config::kGravity_mps2; }
  // Its attitudes are appendix E's, whatever yaw is asked for.
  void leave_heading(bool left) { heading_left_ = left; }
  // lift: share of the weight that is carried (below 1 while taking off and touching down).
  ThrustAndAttitude step(const Vector3& p_WB_W_m, const Vector3& v_WB_W_mps, const Quaternion& q_WB,
                         const Reference& reference, float lift, float dt_s, bool integrating);
  // Its vertical part alone, per mass.
  float height_force(const Vector3& p_WB_W_m, const Vector3& v_WB_W_mps, const Reference& reference,
                     float lift, float dt_s, bool integrating);
  // Without a position: the trim found so far, level but for it, sinking at the given speed.
  ThrustAndAttitude sink(float speed_mps, float sinking_mps, const Quaternion& q_WB, float yaw_rad,
                         float lift) const;
  // m g and what the integral has learned about thrust.
  float hover_thrust_N() const;

 private:
  Vector3 force(const Vector3& p_WB_W_m, const Vector3& v_WB_W_mps, const Reference& reference,
                float lift) const;
  void integrate(const Vector3& p_error_W_m, float dt_s);
  std::optional<float> heading(float yaw_rad) const {
    return heading_left_ ? std::nullopt : std::optional(yaw_rad);
  }
  bool heading_left_ = false;
  Vector3 integral_W_mps2_ = Vector3::Zero();
  // Deceleration by drag over velocity, in level flight.
  float drag_ps_ = config::kDrag_spm * config::kGravity_mps2;
};

}  // namespace fw

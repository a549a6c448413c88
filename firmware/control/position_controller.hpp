// Thrust and attitude from position and velocity errors.
//
//   Source  [Bangura 2017, 6.5.1]: Td Rd e3 = m g e3 - m vd' - c T vd + m (Kp p~ + Kd v~ + integral);
//           the attitude from Rd e3 and heading by (chi nu gamma), errors actual minus desired
//   Limits  tilt, integral; the collective's own limits are the mixer's
#pragma once
#include "firmware/control/reference.hpp"
#include "firmware/math.hpp"

namespace fw {

struct ThrustAndAttitude {
  float thrust_N = 0.0f;
  Quaternion q_WB = Quaternion::Identity();
};

class PositionController {
 public:
  void reset() { integral_W_mps2_.setZero(); }
  // lift: share of the weight that is carried (below 1 while taking off and touching down).
  ThrustAndAttitude step(const Vector3& p_WB_W_m, const Vector3& v_WB_W_mps, const Quaternion& q_WB,
                         const Reference& reference, float lift, float dt_s, bool integrate);
  // Without a position: the trim found so far, level but for it, sinking at the given speed.
  ThrustAndAttitude sink(float speed_mps, const Vector3& v_WB_W_mps, const Quaternion& q_WB,
                         float yaw_rad, float lift) const;
  // m g and what the integral has learned about thrust.
  float hover_thrust_N() const;

 private:
  Vector3 integral_W_mps2_ = Vector3::Zero();
};

}  // namespace fw

// Torque that turns the vehicle into the attitude asked for.
//
//   Source  [Bangura 2017, 6.4]: qe = qd^-1 q, tau = tau_d - KW (W~ + Kq qe_vec), with a trim by an
//           integral of the angle; tau_d is the gyroscopic term W x I W
#pragma once
#include "firmware/math.hpp"

namespace fw {

class AttitudeController {
 public:
  void reset() { trim_B_Nm_.setZero(); }
  Vector3 torque(const Quaternion& q_WB, const Vector3& w_WB_B_radps,
                 const Quaternion& q_WB_desired, float dt_s, bool trim);

 private:
  Vector3 trim_B_Nm_ = Vector3::Zero();
};

}  // namespace fw

// Torque that turns the vehicle into the attitude asked for.
//
//   Source  [Bangura 2017, 6.4]: qe = qd^-1 q, tau = tau_d - KW (W~ + Kq qe_vec), with a trim by an
//           integral of the angle; tau_d = I Wd' + W x I W - tau_D (6.18), tau_D what the rotors' drag
//           makes about the centre of mass by their height above it. The rotors' own spin is left out:
//           two turn each way, in hover it cancels
#pragma once
#include "firmware/config/vehicle.hpp"
#include "firmware/control/desired_attitude.hpp"
#include "firmware/math.hpp"

namespace fw {

class AttitudeController {
 public:
  void reset() { trim_B_Nm_.setZero(); }
  void set_drag(float drag_spm) { drag_spm_ = drag_spm; }
  Vector3 torque(const Quaternion& q_WB, const Vector3& w_WB_B_radps,
                 const ThrustAndAttitude& wanted, float dt_s, bool trim);

 private:
  Vector3 trim_B_Nm_ = Vector3::Zero();
  float drag_spm_ = config::kDrag_spm;
};

}  // namespace fw

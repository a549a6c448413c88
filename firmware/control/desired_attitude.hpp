// The attitude that points the rotors where a force is wanted, with its rate and acceleration.
//
//   Source  [Bangura 2017, 6.5.3]: gamma = Rd e3 along the force, nu = gamma x phi / |gamma x phi| with
//           phi the heading, chi = nu x gamma, Rd = (chi nu gamma); rates from the derivatives of
//           Td Rd e3 (6.40, 6.42)
//   Limits  tilt, and never upside down; the collective's own limits are the mixer's
//   Differs the derivatives are those of the trajectory, not of the errors, and snap counts as 0
#pragma once
#include "firmware/math.hpp"

namespace fw {

struct ThrustAndAttitude {
  float thrust_N = 0.0f;
  Quaternion q_WB = Quaternion::Identity();
  // Of the wanted attitude, along its own axes; and the velocity that goes with it, for drag.
  Vector3 w_B_radps = Vector3::Zero(), w_dot_B_radps2 = Vector3::Zero();
  Vector3 v_B_mps = Vector3::Zero();
  Vector3 next_w_dot_B_radps2 =
      Vector3::Zero();  // of the hold after the next, where that is planned
};

// f: the force T R e3 wanted, per mass, in W, with its first two derivatives. Of the collective only
// the part along the present axis is asked: while still turning, the rest would push elsewhere.
struct WantedForce {
  Vector3 f_W_mps2 = Vector3::Zero(), jerk_W_mps3 = Vector3::Zero(), snap_W_mps4 = Vector3::Zero();
};
ThrustAndAttitude resolve(WantedForce wanted, const Quaternion& q_WB, float yaw_rad);

}  // namespace fw

// The attitude that points the rotors where a force is wanted, with its rate and acceleration.
//
//   Source  [Bangura 2017, 6.5.3]: gamma = Rd e3 along the force, nu = gamma x phi / |gamma x phi| with
//           phi the heading, chi = nu x gamma, Rd = (chi nu gamma); rates from the derivatives of
//           Td Rd e3 (6.40, 6.42)
//   Variant appendix E: qd3 = 0, turned from level about a level axis, its heading left to that. With x, y of
//           gamma q0 = sqrt((1 + sqrt(1 - x^2 - y^2)) / 2), q1 = -y / (2 q0), q2 = x / (2 q0); q0 is positive,
//           as the filters' is. E.1 is written with the conjugate of the quaternion here (R e3 has 2 q0 q2 in
//           x), so the signs of q1 and q2 are the other ones. Refused where x^2 + y^2 > 1
//   Limits  tilt, and never upside down; the collective's own limits are the mixer's
//   Differs the derivatives are those of the trajectory, not of the errors, and snap counts as 0
#pragma once
#include <optional>

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
// Without a yaw it is appendix E's; where that is refused, the present attitude stays.
ThrustAndAttitude resolve(WantedForce wanted, const Quaternion& q_WB, std::optional<float> yaw_rad);

// Appendix E, upright; nothing where x and y are together longer than gamma, or no numbers.
std::optional<Quaternion> without_heading(float x, float y);

}  // namespace fw

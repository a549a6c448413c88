// Rotor thrusts from collective thrust and torque, and the set-points that ask for them.
//
//   Geometry  rotors 1..4 at +x, +y, -x, -y of B, thrust along -z:
//             tau_x = l (T4 - T2), tau_y = l (T1 - T3), tau_z = q (T1 - T2 + T3 - T4)
//   Limits    what does not fit is given up in this order: yaw, then roll and pitch (scaled together,
//             so that the axis of the torque stays); collective thrust last
#pragma once
#include <array>
#include <cstdint>

#include "firmware/math.hpp"

namespace fw {

using RotorThrusts = std::array<float, 4>;  // N, rotor 1 first

RotorThrusts mix(float thrust_N, const Vector3& tau_B_Nm);

// Value on the wire for "thrust by RPM", 1..2047.
std::uint16_t setpoint_for(float thrust_N);

}  // namespace fw

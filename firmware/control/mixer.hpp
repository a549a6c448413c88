// Rotor thrusts from collective thrust and torque, and the set-points that ask for them.
//
//   Geometry  rotors 1..4 at +x, +y, -x, -y of B, thrust along -z:
//             tau_x = l (T4 - T2), tau_y = l (T1 - T3), tau_z = q (T1 - T2 + T3 - T4)
//   Limits    what does not fit is given up in this order: yaw, then roll and pitch (scaled together,
//             so that the axis of the torque stays); collective thrust last. But where one rotor of a
//             pair has come to its lower limit, the pair carries more for as long as the torque is asked
//             for, and the other pair a little less: that nearly doubles the torque about one axis in
//             hover, and costs some yaw and some climb
//   Ranges    what each rotor can do now, where that is less than its limits
#pragma once
#include <array>
#include <cstdint>

#include "firmware/control/desired_attitude.hpp"
#include "firmware/math.hpp"

namespace fw {

using RotorThrusts = std::array<float, 4>;  // N, rotor 1 first

// Of the range of the four rotors together: 0 the least, 0.5 what hovers, 1 the most.
float collective_N(float share, float hover_N);

struct ThrustRange {
  float low_N, high_N;
};
using ThrustRanges = std::array<ThrustRange, 4>;
ThrustRanges all_thrusts();

// What each pair shall carry beyond its share of the thrust.
struct PairLifts {
  float fore_and_aft_N = 0.0f, across_N = 0.0f;  // of each rotor
};
// Of a turn that is planned: nothing brakes a rotor, and the more it carries, the sooner it falls. So a pair that turns
// the vehicle is brought up meanwhile, by half as much again as half the difference that it has to make now or in the next hold; what
// there is no room for is left out.
PairLifts lifts_for(const ThrustAndAttitude& wanted);

RotorThrusts mix(float thrust_N, const Vector3& tau_B_Nm, const ThrustRanges& ranges,
                 const PairLifts& lifts = {});
inline RotorThrusts mix(float thrust_N, const Vector3& tau_B_Nm) {
  return mix(thrust_N, tau_B_Nm, all_thrusts());
}

// Value on the wire for "thrust by RPM", 1..2047.
std::uint16_t setpoint_for(float thrust_N);

}  // namespace fw

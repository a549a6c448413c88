// What the air takes from the shaft, from what the ESC measures.
//
//   Law     Pam = ((Kq0 + Kq1 i) i - drag) w - Ir w w'; i is the bus current over the duty
//           [Bangura 2017, eq. 5.4; its Kq1 counts the other way, for its current is the bus's]
//   Valid   at a duty that the winding current does not leave (no gaps); constants of one bridge and
//           one PWM pattern, found against a torque cell
//   Error   0.05 % of power over 3600 to 5700 rpm on the switched motor, if the constants are fitted
#pragma once
#include "firmware/esc/core/calibration.hpp"

namespace fw::esc {

inline float shaft_torque_Nm(const TorqueMap& map, float current_A) {
  return (map.Kq0_NmpA + map.Kq1_NmpA2 * current_A) * current_A - map.drag_Nm;
}

// What one ampere of the bus more would add to the power: how far an offset of the shunt goes.
inline float power_per_bus_ampere_W(const TorqueMap& map, float current_A, float w, float duty) {
  return (map.Kq0_NmpA + 2.0f * map.Kq1_NmpA2 * current_A) * w / duty;
}

}  // namespace fw::esc

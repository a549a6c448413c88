// What the air takes from the shaft, from what the ESC measures.
//
//   Law     Pam = va i - (loss_ohm i + loss_V + share va + back_emf w) i - drag w - Ir w w', with i the
//           bus current over the duty and va the bus voltage times the duty
//   Why not Kt i w alone [Bangura 2017, eq. 5.4]: docs/thrust_estimator.md
//   Valid   while the winding current has no gaps; constants of one bridge and one PWM pattern, found
//           against a torque cell
//   Error   0.05 % of power (one sigma) over 4100 to 5800 rpm on the switched motor with fitted
//           constants; 0.15 % without share and back_emf
#pragma once
#include "firmware/esc/core/calibration.hpp"

namespace fw::esc {

inline float lost_V(const LossMap& map, float voltage_V, float current_A, float w) {
  return map.loss_ohm * current_A + map.loss_V + map.share * voltage_V + map.back_emf_Vs * w;
}

// At constant speed.
inline float aerodynamic_power_W(const LossMap& map, float voltage_V, float current_A, float w) {
  return (voltage_V - lost_V(map, voltage_V, current_A, w)) * current_A - map.drag_Nm * w;
}

// While the PWM is off a diode carries the current: on another bus for another share of the time than on the one
// on which the losses were found, where loss_V and share have its part. What is lost less than there.
inline float freed_by_bus_V(const LossMap& map, float freewheel_V, float voltage_V, float bus_V) {
  if (!(map.bus_V > 0.0f)) return 0.0f;
  return freewheel_V * voltage_V * (map.bus_V - bus_V) / (map.bus_V * bus_V);
}

// Under diode freewheel the winding current falls to nothing between two pulses if it is smaller than
// half its ripple; the losses are others then.
inline bool has_gaps(const MotorConstants& motor, float bus_V, float duty, float current_A) {
  constexpr float kPwm_Hz = 20e3f;
  const float ripple_V = bus_V * duty * (1.0f - duty);  // over L f it is a current
  return current_A * (motor.inductance_H * kPwm_Hz) < 0.5f * ripple_V;
}

// What one ampere more would add to it; over the duty, one of the bus: how far an offset of the shunt
// goes.
inline float power_per_ampere_W(const LossMap& map, float voltage_V, float current_A, float w) {
  return voltage_V - lost_V(map, voltage_V, 2.0f * current_A, w);  // the square's derivative
}

}  // namespace fw::esc

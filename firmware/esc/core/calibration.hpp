// What one ESC knows about its motor, propeller and sensors: measured on a stand, kept in flash. Where each
// default comes from, and what the stock board has instead: docs/calibration.md.
//
//   Units    SI, line to line (two windings conducting)
//   Defaults a 950 Kv motor with a 10 x 4.5 propeller; sane, not measured: `identified` says so
//   Source   motor and static map [Bangura 2017, sec. 3.4]
#pragma once
#include <cstdint>

#include "firmware/esc/core/setpoint.hpp"
#include "firmware/esc/core/thrust_model.hpp"

namespace fw::esc {

struct MotorConstants {
  float Kt_NmpA = 0.01005f;  // and back-EMF, V s
  float resistance_ohm = 0.12f;
  float inductance_H = 2.2e-5f;
  float overlap_ohm_s = 8e-5f;  // drop of commutation per ampere and rad/s of the shaft
  float freewheel_V = 0.7f;     // diodes that carry the current while the PWM is off; 0: switches
  float no_load_current_A = 1.0f;
  float inertia_kgm2 = 3.752e-5f;
  float max_current_A = 20.0f;  // of the winding
  float max_braking_A = 15.0f;  // of the winding, regenerated
};

// What of the electrical power does not reach the air at constant speed: (loss_ohm i + loss_V + share va
// + back_emf_Vs w) i + drag w, with i = bus current / duty and va = bus voltage x duty.
struct LossMap {
  float loss_ohm = 0.12f;
  float loss_V = 0.25f;
  float share = 0.0f;        // of Kt i w, the second witness of power
  float back_emf_Vs = 0.0f;  // negative, about -share Kt
  float drag_Nm = 0.01005f;
  float bus_V = 0.0f;  // at which these were found (power_balance.hpp); 0: not known
};

// Free air: T = CT(w) w^2, P = CP(w) w^3. Both bend with speed: Reynolds number, a soft blade's twist.
struct StaticMap {
  float a3 = 0.0f;
  float a2 = 1.6314e-5f;
  float a1 = -1.4052e-3f;
  float q4 = 0.0f;
  float q3 = 0.0f;
  float q2 = 2.3e-7f;

  float CT(float w) const { return a3 * w + a2 + a1 / w; }
  float CP(float w) const { return (q4 * w + q3) * w + q2; }
  void take_still_power(float share) { q4 *= share, q3 *= share, q2 *= share; }  // of CP
};

// Where the losses and the rotor's model were identified, and how they change with speed in there.
struct PowerRange {
  float from_radps = 0.0f;  // outside, power is not asked
  float to_radps = 2000.0f;
  // 1 - power ratio, times 1 + effect (w / middle - 1), is the model's, which has one shape for all speeds.
  float speed_effect = 0.0f;

  bool holds(float w) const { return w >= from_radps && w <= to_radps; }
};

struct CurrentSense {
  float gain = 1.0f;
  float offset_A = 0.0f;   // taken off before the gain
  float warm_up_A = 0.4f;  // what the zero drifts by after power-up, one sigma
};

struct Calibration {
  MotorConstants motor;
  LossMap losses;
  PowerRange power;
  StaticMap free_air;
  CurrentSense sense;
  // From this share of still air's power on, an updraft may give a downdraft's power: nothing is concluded
  // then. Above 1.1: the air is known to come from above, as on a flow generator.
  float shared_power = 0.97f;
  ThrustModel rotor{};  // all zero: not identified, modes 4 and 5 fall back to the static map
  float arming_voltage_V = 15.7f;  // at rest
  Mode mode = Mode::thrust_by_speed;
  bool identified = false;

  // The motor, with no more current than is told apart: a shunt that nobody has held against an ammeter may
  // read a tenth low, and nobody knows of the motor how far its ripple reaches above the mean.
  MotorConstants motor_within_limits() const {
    MotorConstants limited = motor;
    if (!identified) limited.max_current_A *= 0.9f;
    return limited;
  }
};

}  // namespace fw::esc

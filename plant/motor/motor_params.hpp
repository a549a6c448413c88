// What both faces of the motor model (averaged_motor.hpp, switched_motor.hpp) are made of.
//
//   Units    SI; resistance, inductance and constants are line-to-line: two windings conducting
//   Source   [Bangura2017, sec. 3], read physically: the shunt sits on the bus
//   Defaults Turnigy D2836/9 950 KV with ESC32v2, leads and a 10 x 4.5 propeller
//   R and L  what an ohmmeter and an LCR bridge would show. A resistance fitted on a running motor
//            is larger: moving the current from phase to phase against the inductance takes
//            (3/pi) w_e (L/2) I, and both faces count that by themselves. The thesis's steady points
//            show 0.12 to 0.18 ohm; with 7 pole pairs 0.1 mH alone would look like 0.17 ohm at
//            5000 RPM. 0.070 ohm of winding, 0.050 of bridge, leads and warmth and 20 uH look like 0.148
//            to 0.159 ohm from 4000 to 5500 RPM and meet voltage, bus current and thrust at once
#pragma once
#include <string>

#include "base/result.hpp"

namespace whirl::plant {

enum class BackEmf { trapezoidal, sinusoidal };

struct MotorParams {
  double torque_constant_NmpA = 0.01005;  // = back-EMF constant in V s/rad = 60/(2 pi Kv)
  double resistance_ohm = 0.120;          // winding, bridge and leads, at winding_ref_temp_K
  double winding_resistance_ohm = 0.070;  // the share of it that warms with the winding
  double inductance_H = 2.0e-5;
  double no_load_current_A = 1.0;  // iron and friction: a torque that opposes rotation
  double inertia_kgm2 = 3.752e-5;  // rotor, bell and propeller about the shaft
  int pole_pairs = 7;
  double pwm_Hz = 20e3;
  double diode_drop_V = 0.7;                // body diodes of the bridge
  BackEmf back_emf = BackEmf::trapezoidal;  // switched face only

  // Winding temperature; a capacity of 0 keeps the winding at the reference temperature.
  double heat_capacity_JpK = 0.0;
  double heat_resistance_KpW = 3.0;
  double winding_ref_temp_K = 293.15;
  double ambient_temp_K = 293.15;
  double copper_temp_coefficient_pK = 0.00393;
};

Result<Done> validate(const MotorParams& params, const std::string& place);

}  // namespace whirl::plant

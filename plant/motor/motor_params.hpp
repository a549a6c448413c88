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
#include <array>
#include <string>

#include "base/result.hpp"

namespace whirl::plant {

enum class BackEmf { trapezoidal, sinusoidal };

// What one motor's own three phases differ in, and how its iron pulls. Switched face only: the mean over
// a revolution, which the averaged face is, hardly knows of it.
struct PhaseErrors {
  // Shares by which a phase's resistance and inductance (turns, solder, wire: both together), and its
  // back-EMF, lie above what MotorParams has for each.
  std::array<double, 3> impedance{}, emf{};
  double sine_share = 0.0;  // of the back-EMF's shape; the rest is that of MotorParams::back_emf
  double cogging_Nm = 0.0;  // amplitude; kCogs periods in an electrical revolution
  static constexpr double kCogs = 12.0;  // 12 slots, 14 magnets: 84 in a turn of the shaft
};

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
  PhaseErrors phases;

  // Winding temperature; a capacity of 0 keeps the winding at the reference temperature.
  double heat_capacity_JpK = 0.0;
  double heat_resistance_KpW = 3.0;
  double winding_ref_temp_K = 293.15;
  double ambient_temp_K = 293.15;
  double copper_temp_coefficient_pK = 0.00393;
  double magnet_temp_coefficient_pK =
      -0.001;                    // of torque constant and back-EMF: NdFeB, -0.09 to -0.12 %/K
  double bearing_share = 0.0;    // of the no-load torque: grease, thinner when warm
  double bearing_fade_K = 25.0;  // warmer by this, and 1/e of it is left
  double start_temp_K = 293.15;  // of the winding, at power-up; counts with a capacity only
};

// The same motor at another temperature of winding, magnets and bearings, taken as one: resistance,
// torque constant and no-load current as they are then. At winding_ref_temp_K it is `cold` itself.
MotorParams at_temperature(const MotorParams& cold, double temperature_K);

// Of the heat in all of the resistance, what stays in the winding.
double winding_share(const MotorParams& cold, const MotorParams& now);

// Where the temperature goes in dt_s under this heat: one node against the air. Without a capacity it stays.
double warmed_K(const MotorParams& cold, double temperature_K, double heat_W, double dt_s);

Result<Done> validate(const MotorParams& params, const std::string& place);

}  // namespace whirl::plant

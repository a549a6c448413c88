// What six-step commutation at neutral timing does to the mean of the currents. Derivation, and which
// numbers have none: docs/commutation.md.
//
//   Pair     i, the mean of what the two tied phases carry; y, what the third one carries beside them
//   Dip      at a commutation the outgoing current I becomes y, and i falls to I/2 and recovers
//   Tail     y runs down through a diode: into the bus (fast) or below ground (slow)
//   Circuit  the open phase's negative back-EMF drives a y of its own through its lower diode: a brake
//   Dry      under diodes a dip below half the ripple lasts no longer than its PWM period
//   Valid    four PWM periods in a sector (a 2300 Kv motor at 24 kHz: up to 9000 RPM; beyond, diodes
//            leave the bus current up to 2.5 % off); a tail shorter than its sector
//   Source   derived in docs/commutation.md; oracle: the switched face (tests/faces_test.cpp)
#pragma once
#include "plant/motor/motor_params.hpp"

namespace whirl::plant {

struct CommutationState {
  double bus_V = 0.0, duty = 0.0;
  bool diode = false;
  double resistance_ohm = 0.0;
  double speed_radps = 0.0;  // of the shaft
  double pair_A = 0.0;       // mean of i
  double dry_A = 0.0;        // diode: the least mean that pulses keep up
  double dry_s = 0.0;        // how long a lack of it lasts
  double ripple_A = 0.0;     // peak to peak
  double falls_s = 0.0;      // diode: how long the pulsed phase conducts after its pulse
};

struct Commutation {  // the mean of i leads to (u - E - volts) / (R + ohm)
  double ohm = 0.0, volts = 0.0;
  double wobble_A2 = 0.0;  // mean of i^2 less the square of the mean, PWM ripple not counted
  double dry_A = 0.0;      // diode: what the mean of i does not fall below
  double third_A = 0.0;    // mean of |y|
  double diode_A = 0.0;    // what diodes carry of it, less what others carry less for it
  double third_A2 = 0.0;   // mean of y^2
  double push_A = 0.0;     // mean of e_y y / E
};

Commutation commutate(const MotorParams& params, const CommutationState& state);

}  // namespace whirl::plant

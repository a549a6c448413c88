// What six-step commutation at neutral timing does to the mean of the currents.
//
//   Pair     i, the mean of what the two tied phases carry; y, what the third one carries beside them.
//            With e_y its back-EMF, exactly: L di/dt = u - E - R i; power E i + e_y y; heat
//            R i^2 + 3/4 R y^2; |phase currents| / 2 = i + |y| / 2 [sum the three loops of the star]
//   Dip      at each commutation the current I of the outgoing phase becomes y, and i falls to I/2.
//            Over a sector T_s it recovers with L/R: the mean i lies below (u - E)/R, as if it met
//            (L / 2 T_s) I more volts. That drop takes no power
//   Tail     y runs down through a diode: into the bus after a change of the low side (fast), below
//            ground after one of the high side (slow, against the back-EMF); it heats and pushes on
//   Circuit  while the pulsed leg is off, the open phase's negative back-EMF drives a y of its own
//            through its lower diode: a brake. What it carries at the end of a sector that closes
//            its low switch deepens the dip by 3/4 of it
//   Dry      under diodes a dip below half the ripple lasts no longer than its PWM period
//   Valid    four PWM periods in a sector (a 2300 Kv motor at 24 kHz: up to 9000 RPM; beyond, diodes
//            leave the bus current up to 2.5 % off); a tail shorter than its sector
//   Source   derived here; oracle: the switched face (tests/faces_test.cpp)
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

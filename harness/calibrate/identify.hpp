// From the stand's data to the ESC's constants: current sense, motor, propeller in still air.
//
//   Current  of the winding = bus current / duty; the shunt sits on the bus
//   Units    SI, line to line; the names are those of the ESC's `set`
//   Fits     each is one linear regression (regression.hpp), kept whole for the report
//   Interval of one fit, given the fits before it: q2, q1 and the rotor's do not hold the losses' own
//   Error    synthetic data with known constants and noise: tests/identify_test.cpp
//   Source   [Bangura 2017, 3.3.2 current sense, 3.4 motor and static maps]
#pragma once
#include "harness/calibrate/data.hpp"
#include "harness/regression/regression.hpp"

namespace whirl::calibrate {

using regression::Coefficient;
using regression::Fit;

// meter = gain (told - offset); the offset is that at rest, where the image finds its own zero.
struct SenseFit {
  Coefficient gain, offset;
  Fit fit;
  double true_A(double told_A) const { return gain.value * (told_A - offset.value); }
};

struct MotorFit {
  // Q w = va i - (loss_ohm i + loss_V + loss_share va + loss_emf w) i - drag w
  Coefficient loss_ohm, loss_V, loss_share, loss_emf, drag;
  double bus_V = 0.0;  // mean of the points that they were fitted on, as the ESC senses it
  Coefficient torque_constant, no_load_current;  // i = no_load + Q / kt
  Coefficient back_emf, resistance, overlap;     // motor voltage over speed and current
  Coefficient inertia;                           // from the transients
  Fit losses, torque, voltage, impulse;
  // What reaches the air at constant speed, as the ESC computes it.
  double power_W(double voltage_V, double current_A, double speed_radps) const;
  double power_W(const SteadyPoint& point) const;
};

struct StillAirFit {              // T = a3 w^3 + a2 w^2 + a1 w, Q = (q4 w^2 + q3 w + q2) w^2
  std::vector<Coefficient> a, q;  // a2, a1, a3 and q2, q3, q4; Q by the ESC's own power balance
  double updraft_share = 0.0;  // of still air's power, the least in the updrafts; 0: none measured
  Fit thrust, torque;
  double CT(double w) const;
  double CP(double w) const;
};

Result<SenseFit> fit_sense(const StandData& data);
Result<MotorFit> fit_motor(const StandData& data, const SenseFit& sense);
Result<StillAirFit> fit_still_air(const StandData& data, const MotorFit& motor);

// "kt: -0.01 is not physical": a bad_input error unless low < value.
Result<Done> physical(const Coefficient& c, double low);

}  // namespace whirl::calibrate

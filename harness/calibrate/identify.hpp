// From the stand's data to the ESC's constants: current sense, motor, propeller in still air.
//
//   Current  of the winding = bus current / duty; the shunt sits on the bus
//   Units    SI, line to line; the names are those of the ESC's `set`
//   Fits     each is one linear regression (regression.hpp), kept whole for the report
//   Error    synthetic data with known constants and noise: tests/identify_test.cpp
//   Source   [Bangura 2017, 3.3.2 current sense, 3.4 motor and static maps]
#pragma once
#include "harness/calibrate/data.hpp"
#include "harness/calibrate/regression.hpp"

namespace whirl::calibrate {

struct SenseFit {  // meter = gain (told - offset)
  Coefficient gain, offset;
  Fit fit;
  double true_A(double told_A) const { return gain.value * (told_A - offset.value); }
};

struct MotorFit {
  Coefficient kq0, kq1, drag;                    // Q = (kq0 + kq1 i) i - drag
  Coefficient torque_constant, no_load_current;  // the same as a line: i = no_load + Q / kt
  Coefficient back_emf, resistance, overlap;     // motor voltage over speed and current
  Coefficient inertia;                           // from the transients
  Fit map, torque, voltage, impulse;
  double torque_Nm(double current_A) const {
    return (kq0.value + kq1.value * current_A) * current_A - drag.value;
  }
};

struct StillAirFit {  // T = a2 w^2 + a1 w, Q = q2 w^2 + q1 w
  Coefficient a2, a1, q2, q1;
  Fit thrust, torque;
  double CT(double w) const { return a2.value + a1.value / w; }
  double CP(double w) const { return q2.value + q1.value / w; }
};

Result<SenseFit> fit_sense(const StandData& data);
Result<MotorFit> fit_motor(const StandData& data, const SenseFit& sense);
Result<StillAirFit> fit_still_air(const StandData& data);

// "kt: -0.01 is not physical": a bad_input error unless low < value.
Result<Done> physical(const Coefficient& c, double low);

}  // namespace whirl::calibrate

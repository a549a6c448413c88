// A motor's constants from measured rows of V, rpm and A, each with its 95 % interval, or why the rows
// do not tell it.
//
//   Model    V = Ke w + R I, and of a running six-step motor another (3/pi) w_e (L/2) I: commutation
//            (docs/commutation.md), by the file's inductance and pole pairs; I = I0 + Q / Kt
//   R        three of them, for people mean different things:
//            seen       slope of V over I as the rows show it, commutation in it. Where one propeller gives all rows,
//                       current rises as the square of speed, and commutation, which rises with speed itself, is
//                       counted twice: R + 2 (3/pi) w_e (L/2) at the middle speed. Each commutation also hands
//                       current back to the bus, so that less of the winding's is seen the faster it turns
//            ohmmeter   commutation taken out: winding, bridge and leads, warm as they were; the file's `resistance`
//            winding    less the file's bridge and leads: what a data sheet prints, which is measured cold
//                       at the motor's own leads
//   I0       by torque, where the rows have it; else by what is left at no speed of a load that grows as speed to
//            the power 2, between 1.85 (blades at low Reynolds number) and 2.05: the interval holds both
//   Method   least squares, errors as shares of the voltage; Student's t. Rows below full throttle are passed over:
//            what of them is the ESC's is not known
//   Error    coverage of the intervals over 200 motors that were drawn: tests/motor_constants_test.cpp
//   Left out iron losses that grow with speed (they count as I0 and load), warming from row to row
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "harness/regression/regression.hpp"
#include "harness/sweep/drive_rows.hpp"
#include "plant/motor/motor_params.hpp"

namespace whirl::sweep {

inline constexpr double kFull_throttle = 0.995;  // a duty that passes for it

struct MotorConstants {
  std::optional<regression::Coefficient> kv_rpm_per_V, seen_ohm, ohmmeter_ohm, winding_ohm;
  std::optional<regression::Coefficient> no_load_A;
  std::vector<std::string> untold;  // by the rows, and why
  std::vector<std::string> notes;
  int rows = 0;
  double commutation_ohm = 0.0;  // at the rows' mean speed
};

// An Error where there is nothing to fit: no voltage, fewer than 4 rows at full throttle.
Result<MotorConstants> motor_constants(const std::vector<DriveFile>& files,
                                       const plant::MotorParams& motor);

// Where a motor of these constants turns at a row's V and A.
double speed_at(const DriveRow& row, const plant::MotorParams& motor);

// What the mean sees beside R: per rad/s of the shaft.
double commutation_ohm_per_radps(const plant::MotorParams& motor);

}  // namespace whirl::sweep

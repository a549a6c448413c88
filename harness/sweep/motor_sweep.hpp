// A motor alone, over the torque of its shaft at full throttle, and beside measured rows of V, rpm and A.
//
//   Judged  speed at each row's voltage and current (WMAPE); and whether the file's constants lie in the intervals
//           that the rows give (motor_constants.hpp), widened by what files and motors may differ: Kv
//           3 % (magnets, timing), R 10 % (25 K of copper), I0 25 % (bearings)
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "harness/sweep/motor_constants.hpp"
#include "results/charts.hpp"

namespace whirl::sweep {

inline constexpr double kMost_speed_percent = 2.0;

struct MotorSweep {
  std::vector<results::Chart> charts;
  std::vector<std::string> lines;  // each constant: by the rows, by the file
  std::vector<std::string> wrong;  // constants of the file that the rows contradict
  double speed_percent = 0.0;      // WMAPE
};
Result<MotorSweep> motor_sweep(const plant::MotorParams& motor, double bus_V,
                               const std::vector<DriveFile>& measured);

}  // namespace whirl::sweep

// What a calibration tells: a table for the terminal, charts for the page, lines for the ESC.
#pragma once
#include <string>
#include <vector>

#include "harness/calibrate/identify.hpp"
#include "harness/calibrate/rotor_fit.hpp"
#include "harness/calibrate/setup.hpp"
#include "results/charts.hpp"

namespace whirl::calibrate {

struct Calibration {
  StandData data;
  SenseFit sense;
  MotorFit motor;
  StillAirFit still;
  RotorFit rotor;
  // Also kt, no_load, resistance, overlap. They are apparent, of bus current over duty, which is up to a tenth
  // less than the winding's: max_current is told with them, as much less.
  bool tell_motor = false;
  // As of Setup. Thinner air takes less power, and so does a downdraft: `shared` is told as much lower.
  double air_within = 0.0;
};

Result<Calibration> identify(StandData data);
// The same, to be told as the setup wants it: `tell_motor`, `air_within`.
Result<Calibration> identify(StandData data, const Setup& setup);
// What must hold before an ESC is told: see physical() of each fit.
Result<Done> physical(const Calibration& calibration);

// "set kt 0.01005", in the ESC's own words and units.
std::vector<std::string> lines(const Calibration& calibration);
// The same as a Lua file that plans include; `made_by`: the command that wrote it.
std::string lua_file(const Calibration& calibration, const std::string& made_by);

std::string table(const Calibration& calibration);
std::vector<results::Chart> charts(const Calibration& calibration);

// Thrust found back from each point's power, as the ESC will do it: error over thrust; NaN where the
// ESC's solver finds power to tell nothing about inflow.
std::vector<double> found_back(const RotorFit& rotor);

}  // namespace whirl::calibrate

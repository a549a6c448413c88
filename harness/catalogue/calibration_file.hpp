// What is to be calibrated, as its user writes it (test_plans/calibrations/*.lua): the stand, the
// propeller's radius as a ruler tells it, and the points to measure.
//
//   return { kind = "calibration", image = "esc", board = "esc32v2", diameter = "10 in",
//            stand = { prop = "hk_10x4.5", supply = "16.4 V" } }
//   May  still = { "14 %", ... }   duties of the points in still air, rising
//        blown = { "22 %", ... }   duties of the points in wind
//        transient = { "47 %", "54 %" }  between which duty steps and swings
//        winds = { "1.5 m/s", ... } speeds of the flow generator
//        updraft = "3 m/s"          from below, the strongest that is to be told from a downdraft
//        air_within = "3 %"         how far the air's density may be off that of the calibration when the ESC flies
//        tell_motor = true          the apparent motor constants too: see calibrate::Calibration
//        settle, measure, warm_up  times; density, seed
#pragma once
#include <string>

#include "base/result.hpp"
#include "harness/calibrate/setup.hpp"
#include "harness/lua/table.hpp"
#include "harness/stand/stand_params.hpp"

namespace whirl::catalogue {

struct CalibrationFile {
  calibrate::Setup setup;
  lua::Table stand;  // stand_table.hpp; not finished yet
};

Result<CalibrationFile> read_calibration(const std::string& path);

// Of the air that the stand says, kg/m3, and where it says none of the calibration's own day.
double density_of(const calibrate::Setup& setup, const stand::StandParams& stand);

}  // namespace whirl::catalogue

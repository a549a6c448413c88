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
//        tell_motor = true          the apparent motor constants too: see Calibration::tell_motor
//        settle, measure, warm_up  times; density, seed
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "harness/lua/table.hpp"

namespace whirl::calibrate {

struct Setup {
  std::string file, image, board;
  std::optional<lua::Table> stand;  // read by who makes the world
  std::uint16_t serial = 1;         // the ESC's line, as the stand numbers it
  double diameter_m = 0.0;
  double density_kgpm3 = 1.225;
  std::vector<double> still, blown;          // duties
  double low_duty = 0.47, high_duty = 0.54;  // of the transients
  std::vector<double> winds_mps;
  double updraft_mps = 3.0;  // 0: none
  std::int64_t warm_up_ms = 0, settle_ms = 700, measure_ms = 800;
  bool tell_motor = false;
  std::uint64_t seed = 1;
};

Result<Setup> read_setup(const std::string& path);

}  // namespace whirl::calibrate

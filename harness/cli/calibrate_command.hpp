// whirl calibrate: the bench procedures on a stand, their fits on the terminal and on a page, and the
// constants as a file that plans include.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "harness/cli/composition.hpp"
#include "harness/inflow_bound/report.hpp"

namespace whirl::cli {

struct CalibrateOptions {
  std::string file;   // test_plans/calibrations/NAME.lua
  std::string write;  // the Lua file of constants; empty: into the results' folder only
  std::string data;   // of an earlier run: only fit it again, without the stand
  std::optional<std::uint64_t> seed;  // another copy of the hardware than the file's
  std::string command;                // as typed, noted in that file
};

// Errors  bad_input: the calibration's file, its stand or its propeller
Result<inflow_bound::Report> inflow_bound_of(const std::string& file, const std::string& root);

// What inflow an ESC of that stand can tell from power: table, and a page of curves.
int inflow_bound_command(const std::string& file, const Composition& composition);

int calibrate_esc_command(const CalibrateOptions& options, const Composition& composition);

}  // namespace whirl::cli

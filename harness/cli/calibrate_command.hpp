// whirl calibrate: the bench procedures on a stand, their fits on the terminal and on a page, and the
// constants as a file that plans include.
#pragma once
#include <string>

#include "harness/cli/composition.hpp"

namespace whirl::cli {

struct CalibrateOptions {
  std::string file;     // test_plans/calibrations/NAME.lua
  std::string write;    // the Lua file of constants; empty: into the results' folder only
  std::string data;     // of an earlier run: only fit it again, without the stand
  std::string command;  // as typed, noted in that file
};

int calibrate_esc_command(const CalibrateOptions& options, const Composition& composition);

}  // namespace whirl::cli

// The command line: one line in, one answer out. Numbers are read and written by hand: no printf.
//
//   duty 20 | rpm 3500 | thrust 2.0 | power 12.0 | st 2.0   set-point in its mode (25 zeros arm: `arm`)
//   mode 0..5 | status | stop | arm | watch 0|1 | save | motor 1..4 | zero
//   set NAME VALUE | get NAME                               calibration, by the names of calibration.hpp
#pragma once
#include <string_view>

#include "firmware/esc/core/core.hpp"
#include "firmware/esc/image/settings.hpp"

namespace fw::esc {

// The answer is queued on the serial line.
void execute(std::string_view line, Core& core, Settings& settings);

}  // namespace fw::esc

// whirl sweep and whirl validate: figures on the terminal, curves on a page.
#pragma once
#include <string>
#include <vector>

#include "harness/cli/composition.hpp"

namespace whirl::cli {

struct SweepOptions {
  std::string file;   // a propeller, motor, stand or vehicle
  std::string speed;  // "4500 rpm"; empty: three quarters of the top
  std::string top_speed = "6000 rpm";
  std::vector<std::string> speeds;     // "4500 rpm", ...: of a propeller's curves over J
  std::vector<double> advance_ratios;  // of its curves over speed; empty: 0, 0.2, 0.4
  std::string voltage;                 // of the bus; empty: the full pack
  std::vector<std::string> measured;   // of all but a vehicle: files to lay over
  std::string seeds;                   // "1..100": the spread of its copies instead
  std::string tolerance;               // of these; empty: the file's, or typical
};
int sweep_command(const SweepOptions& options, const Composition& composition);

// A propeller, motor or stand against files of its own measured points: exit code 1 if its flight is off by more than
// nine in ten left-out propellers are (CT 12 %, CP 14 %); if a motor's speed or constants are
// (motor_sweep.hpp), or a stand's speed, current, thrust or torque (stand_sweep.hpp).
int validate_file_command(const std::string& file, const std::vector<std::string>& measured,
                          const Composition& composition);

// Exit code 1 if a figure is beyond its limit.
int validate_command(const Composition& composition);

struct TimingOptions {
  bool wanted = false;
  std::string file;  // lines that a board sent; empty: run both images on the virtual board
};
// What instructions cost on the board against the data sheets. Exit code 1 if a kernel is beyond 10 % of its
// range or did not report.
int timing_command(const TimingOptions& options, const Composition& composition);

}  // namespace whirl::cli

// What the command line asked for.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/setting.hpp"

namespace whirl::cli {

struct RunOptions {
  std::vector<std::string> paths;  // plans or folders; empty: test_plans
  std::optional<std::uint64_t> seed;
  std::vector<std::uint64_t> seeds;  // each plan on each of them; empty: once, on `seed` or its own
  double limits_margin = 0.0;        // relative; 0: no limits are proposed
  int jobs = 1;
  bool gdb = false;
  int gdb_port = 1234;
  std::string gdb_board;  // of a plan of several: the node that gdb holds
  bool keep = false;      // a passing run keeps its large logs too
  bool twice = false;
  bool json = false;
  std::string out;  // where results go; empty: results/ of the house
  std::string
      calibrations;  // a folder of `whirl calibrate esc --seed`: each seed's own; empty: the plans'
  std::string tag;
  std::string only;    // the plan of this name
  std::string target;  // "bench/NAME"; empty: the virtual board
  std::string arm;     // the bench's phrase
  std::string copper;  // a capture that tells of buses and pins in the board's place; empty: none
  double copper_rate_Hz = 50e6;  // at which it is looked at, if it has no rate of its own
  Settings settings;
};

}  // namespace whirl::cli

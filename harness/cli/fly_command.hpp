// whirl fly: a flight paced to real time that a MAVLink client watches and commands.
#pragma once
#include <cstdint>
#include <string>

#include "harness/cli/composition.hpp"
#include "harness/cli/options.hpp"

namespace whirl::cli {

struct FlyOptions {
  std::string plan;  // empty: test_plans/flight/free.lua
  std::string udp = "127.0.0.1:14550";
  std::uint16_t listen = 0;  // our own port; 0: one that is free
  double pace = 1.0;
  double seconds = 0.0;               // virtual; 0: until it is interrupted
  std::string image, board, vehicle;  // empty: the plan's
  std::string stick;                  // file of a person's game controller; empty: none
};

// INT, TERM and HUP end it in order. 0: it was flown; no verdict is given. Else as of whirl run.
int fly_command(const FlyOptions& options, const RunOptions& run, const Composition& composition);

}  // namespace whirl::cli

// What a run is put together from, and who puts it together.
//
//   The program composes the virtual board and the flight world (main.cpp); the tests compose fakes,
//   and so prove verdicts, exit codes and results without an emulator.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/catalogue/board_file.hpp"
#include "harness/cli/stand_in_request.hpp"
#include "harness/plan/plan_file.hpp"
#include "harness/target/bench/bridge_link.hpp"
#include "harness/target/bench/can_link.hpp"
#include "harness/target/target.hpp"
#include "harness/world/world.hpp"

namespace whirl::cli {

struct FarBoard {  // in the place of a device of this one
  std::size_t node;
  int motor;  // of that device; 0: none
  const BoardDescription* board;
};

struct Setup {  // of a run; of one board of it, where a target is made
  const plan::Plan& plan;
  std::size_t node;               // in the plan's list; the world surrounds the first
  const BoardDescription& board;  // of that node
  std::string root;               // of the project: test_plans, build, results
  std::string image;              // path of the ELF
  std::string vehicle_file;       // path; empty for a stand
  std::uint64_t seed = 1;
  int gdb_port = 0;  // 0: no gdb
  Settings settings = {};
  std::string folder = {};  // of the run, for what the board's parts leave; empty: nothing is left
  const bench::BenchDescription* bench = nullptr;  // null: the virtual board
  std::string copper = {};                         // a capture; empty: the board tells of its buses
  double copper_rate_Hz = 0.0;
  std::vector<std::string> flashed = {};  // paths of ELF files beside the image
  std::vector<WireEnd> wires = {};        // to other boards
  std::vector<FarBoard> far = {};         // that this one leads
  bool world_may_stand = false;           // gdb holds this board or another one
  int motor = 0;  // of the vehicle: which one this board turns, in a device's place; 0: none
};

struct Composition {
  std::function<Result<std::unique_ptr<World>>(const Setup&)> world;
  std::function<Result<std::unique_ptr<Target>>(const Setup&)> target;
  std::string root;
  std::string results;                  // folder of runs and history
  bench::BridgeMaker bridge = nullptr;  // USB to I2C, of a bench
  bench::CanMaker can = nullptr;        // its CAN buses
  std::function<int(const StandInRequest&)> stand_in = nullptr;
};

// The whole program but its composition. Returns the exit code.
int run_program(int argc, char** argv, const Composition& composition);

}  // namespace whirl::cli

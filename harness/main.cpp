// whirl: the virtual board and its world, a flight or a thrust stand, put together.
#include <algorithm>
#include <cstdlib>
#include <set>

#include "base/interruption.hpp"
#include "base/places.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/catalogue/surroundings_table.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/cli/composition.hpp"
#include "harness/cli/console.hpp"
#include "harness/flight/flight_world.hpp"
#include "harness/stand/stand_world.hpp"
#include "harness/target/virtual_board.hpp"

namespace whirl {
namespace {

Result<stand::StandParams> stand_of(const cli::Setup& setup) {
  return catalogue::read_stand(*setup.plan.stand, setup.root + "/test_plans/propellers");
}

// Each motor has its ESC on the board, and each ESC its motor.
Result<Done> check_escs(const cli::Setup& setup, const flight::FlightParams& params) {
  const int motors = static_cast<int>(params.vehicle.airframe.rotors.size());
  std::set<int> driven;
  for (const BoardDevice& device : setup.board.devices) {
    if (device.type == "esc_i2c") driven.insert(device.motor);
  }
  const auto wrong = [&](const std::string& what) {
    return Error{ErrorKind::bad_input, setup.vehicle_file, what,
                 "the vehicle has " + std::to_string(motors) + " motors, " + setup.board.name +
                     " " + std::to_string(driven.size()) + " ESCs"};
  };
  for (const int motor : driven) {
    if (motor > motors) {
      return wrong("the board's ESC of motor " + std::to_string(motor) + " has no motor");
    }
  }
  for (int motor = 1; motor <= motors; ++motor) {
    if (driven.count(motor) == 0) return wrong("motor " + std::to_string(motor) + " has no ESC");
  }
  return Done{};
}

flight::BoardEars ears_of(const BoardDescription& board) {
  const auto has = [&](std::initializer_list<const char*> types) {
    return std::any_of(board.devices.begin(), board.devices.end(), [&](const BoardDevice& device) {
      return std::find(types.begin(), types.end(), device.type) != types.end();
    });
  };
  return {.radio = has({"mavlink_link"}), .receiver = has({"cppm", "sbus"})};
}

Result<std::unique_ptr<World>> make_world(const cli::Setup& setup) {
  if (setup.plan.stand) {
    const auto params = stand_of(setup);
    if (!params) return params.error();
    return std::unique_ptr<World>(std::make_unique<stand::StandWorld>(params.value(), setup.seed));
  }
  auto params = catalogue::read_vehicle(setup.vehicle_file, setup.settings);
  if (!params) return params.error();
  const auto around = catalogue::read_surroundings(*setup.plan.surroundings, params.value());
  if (!around) return around.error();
  if (const auto joined = check_escs(setup, params.value()); !joined) return joined.error();
  params.value().ears = ears_of(setup.board);
  return std::unique_ptr<World>(std::make_unique<flight::FlightWorld>(params.value(), setup.seed));
}

Result<std::unique_ptr<Target>> make_target(const cli::Setup& setup) {
  VirtualBoardOptions options;
  options.board = {setup.board,
                   {.image = setup.image,
                    .seed = setup.seed,
                    .gdb_port = setup.gdb_port,
                    .folder = setup.folder,
                    .node = setup.plan.nodes[setup.node].name}};
  if (setup.plan.stand && setup.node == 0) {
    const auto params = stand_of(setup);
    if (!params) return params.error();
    const auto set =
        stand::set_stage(options.board.board, params.value().motor, params.value().stage);
    if (!set) return set.error();
  }
  options.any_qemu_version = std::getenv("WHIRL_ANY_QEMU") != nullptr;
  return std::unique_ptr<Target>(std::make_unique<VirtualBoard>(std::move(options)));
}

}  // namespace
}  // namespace whirl

int main(int argc, char** argv) {
  using namespace whirl;
  catch_interruptions();
  base::set_check_handler(base::throw_check_failure);
  const auto& here = places();
  if (!here) return cli::complain(here.error());
  const char* results = std::getenv("WHIRL_RESULTS");
  const bool wanted = results != nullptr && *results != '\0';
  return cli::run_program(argc, argv,
                          {make_world, make_target, here.value().root,
                           wanted ? std::string(results) : here.value().results});
}

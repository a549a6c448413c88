// whirl: the virtual board and its world, a flight or a thrust stand, put together.
#include <cstdlib>

#include "base/interruption.hpp"
#include "base/places.hpp"
#include "harness/catalogue/stand_table.hpp"
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

Result<std::unique_ptr<World>> make_world(const cli::Setup& setup) {
  if (setup.plan.stand) {
    const auto params = stand_of(setup);
    if (!params) return params.error();
    return std::unique_ptr<World>(std::make_unique<stand::StandWorld>(params.value(), setup.seed));
  }
  const auto params = catalogue::read_vehicle(setup.vehicle_file, setup.settings);
  if (!params) return params.error();
  return std::unique_ptr<World>(std::make_unique<flight::FlightWorld>(params.value(), setup.seed));
}

Result<std::unique_ptr<Target>> make_target(const cli::Setup& setup) {
  VirtualBoardOptions options;
  options.board = {setup.board,
                   {.image = setup.image, .seed = setup.seed, .gdb_port = setup.gdb_port}};
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

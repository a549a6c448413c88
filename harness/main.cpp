// whirl: the virtual board and the flight world, put together.
#include <cstdlib>

#include "harness/cli/composition.hpp"
#include "harness/flight/flight_world.hpp"
#include "harness/flight/vehicle_file.hpp"
#include "harness/target/virtual_board.hpp"

namespace whirl {
namespace {

Result<std::unique_ptr<World>> make_world(const cli::Setup& setup) {
  if (setup.vehicle_file.empty()) {
    return Error{ErrorKind::bad_input, setup.plan.place, "a stand is not there yet",
                 "use a vehicle"};
  }
  const auto params = flight::read_vehicle(setup.vehicle_file);
  if (!params) return params.error();
  return std::unique_ptr<World>(std::make_unique<flight::FlightWorld>(params.value(), setup.seed));
}

Result<std::unique_ptr<Target>> make_target(const cli::Setup& setup) {
  VirtualBoardOptions options;
  options.board_json = setup.board_text;
  options.any_qemu_version = std::getenv("WHIRL_ANY_QEMU") != nullptr;
  return std::unique_ptr<Target>(std::make_unique<VirtualBoard>(std::move(options)));
}

}  // namespace
}  // namespace whirl

int main(int argc, char** argv) {
  const char* results = std::getenv("WHIRL_RESULTS");
  return whirl::cli::run_program(
      argc, argv,
      {whirl::make_world, whirl::make_target, WHIRL_ROOT,
       results != nullptr ? std::string(results) : std::string(WHIRL_ROOT) + "/results"});
}

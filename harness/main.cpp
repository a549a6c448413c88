// whirl: its commands, over the virtual boards and benches of this machine.
#include <cstdlib>

#include "base/interruption.hpp"
#include "base/places.hpp"
#include "harness/cli/composition.hpp"
#include "harness/cli/console.hpp"
#include "harness/composition/boards.hpp"
#include "harness/target/bench/hid_port.hpp"

int main(int argc, char** argv) {
  using namespace whirl;
  catch_interruptions();
  base::set_check_handler(base::throw_check_failure);
  const auto& here = places();
  if (!here) return cli::complain(here.error());
  const char* results = std::getenv("WHIRL_RESULTS");
  const bool wanted = results != nullptr && *results != '\0';
  return cli::run_program(
      argc, argv,
      boards_and_worlds(here.value().root, wanted ? std::string(results) : here.value().results,
                        bench::hid_port));
}

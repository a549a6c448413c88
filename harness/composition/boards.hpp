// The virtual board or a bench, and the world around it, a flight or a thrust stand, put together.
#pragma once
#include <string>

#include "harness/cli/composition.hpp"
#include "harness/target/bench/bridge_link.hpp"
#include "harness/target/bench/can_link.hpp"

namespace whirl {

cli::Composition boards_and_worlds(const std::string& root, const std::string& results,
                                   const bench::BridgeMaker& bridge,
                                   const bench::CanMaker& can = bench::socket_can_port);

}  // namespace whirl

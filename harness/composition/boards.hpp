// The virtual board or a bench, and the world around it, a flight or a thrust stand, put together.
#pragma once
#include <string>

#include "harness/cli/composition.hpp"
#include "harness/pacing/host_clock.hpp"
#include "harness/target/bench/bridge_link.hpp"
#include "harness/target/bench/can_link.hpp"

namespace whirl {

// clock: that a bench holds its pace by, and outlives all that comes of this; null: the host's.
cli::Composition boards_and_worlds(const std::string& root, const std::string& results,
                                   const bench::BridgeMaker& bridge,
                                   const bench::CanMaker& can = bench::socket_can_port,
                                   pacing::HostClock* clock = nullptr);

}  // namespace whirl

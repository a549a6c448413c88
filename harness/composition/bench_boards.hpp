// A run on a bench: the links that its file asks for, and what a plan may spoil there.
#pragma once
#include "harness/cli/composition.hpp"
#include "harness/pacing/host_clock.hpp"

namespace whirl {

// Errors  bad_input, with the plan's line: it names a fault that nothing here can have
Result<std::unique_ptr<Target>> bench_target(const cli::Setup& setup,
                                             const bench::BridgeMaker& bridge,
                                             const bench::CanMaker& can, pacing::HostClock& clock);

}  // namespace whirl

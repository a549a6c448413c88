// Several plans at once: one process each, so that a crash in one is that one's internal error.
#pragma once
#include <vector>

#include "harness/cli/find_plans.hpp"
#include "harness/cli/options.hpp"

namespace whirl::cli {

// Returns the worst exit code. Outcomes are printed whole, in the order in which plans end.
int run_in_processes(const std::vector<PlanChoice>& plans, const RunOptions& options);

}  // namespace whirl::cli

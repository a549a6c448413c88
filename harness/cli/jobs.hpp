// Several plans at once: one process each, so that a crash in one is that one's internal error.
//
//   Interrupt  is passed on to the children, which end in order; no more are started
//   Lack       of processes or memory: the plan is inconclusive, by name; while others still run, it
//              waits for one of them and tries again
//   Order      the longest first, as their time-outs tell
//   Cores      where there are not two for each job, a job keeps to one
//   Life       the children end with this process, however it ends
#pragma once
#include <vector>

#include "harness/cli/find_plans.hpp"
#include "harness/cli/options.hpp"
#include "harness/cli/tally.hpp"

namespace whirl::cli {

// Outcomes are printed whole, in the order in which plans end.
void run_in_processes(const std::vector<PlanChoice>& plans, const RunOptions& options,
                      Tally& tally);

}  // namespace whirl::cli

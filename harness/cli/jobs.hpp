// Several plans at once: one process each, so that a crash in one is that one's internal error.
//
//   Interrupt  is passed on to the children, which end in order; no more are started
//   Lack       of processes or memory: the plan is inconclusive, by name; while others still run, it
//              waits for one of them and tries again
//   Order      the longest first, as their time-outs tell
//   Cores      where there are not two for each job, a job keeps to one
//   Exchange   a Job goes in, a JobReport comes back (harness/job/job.hpp); results and history are written
//              here and not by the children, but for the run's own folder
//   Life       the children end with this process, however it ends
#pragma once
#include <vector>

#include "harness/cli/find_plans.hpp"
#include "harness/cli/options.hpp"
#include "harness/cli/outcomes.hpp"

namespace whirl::cli {

// Outcomes are printed whole, in the order in which plans end.
void run_in_processes(const std::vector<PlanChoice>& plans, const RunOptions& options,
                      const std::string& results, Outcomes& outcomes);

}  // namespace whirl::cli

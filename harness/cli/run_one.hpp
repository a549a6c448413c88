// One plan from file to report.
#pragma once
#include "harness/cli/composition.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/options.hpp"
#include "harness/executive/run.hpp"

namespace whirl::cli {

struct Finished {
  results::Report report;
  std::string folder;  // of the results; empty: the run never began, or all was lost
};

// Every mishap ends in the report; this never fails and throws nothing. The folder for the results is
// made before the run, so that a place that cannot be written is known at once.
Finished run_one(const PlanChoice& choice, const RunOptions& options,
                 const Composition& composition, const ProgressSink& progress);

}  // namespace whirl::cli

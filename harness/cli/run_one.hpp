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

// Who goes along with a run, and what he leaves in its folder: files, and notes in the report. Called when
// the run is over, with the plan's file and those that it took in, relative to its folder.
struct Company {
  Companion& companion;
  std::function<Result<Done>(const std::string& folder, results::Report& report,
                             const plan::Plan& plan, const std::vector<std::string>& taken_in)>
      leave;
};

// Every mishap ends in the report; this never fails and throws nothing. The folder for the results is
// made before the run, so that a place that cannot be written is known at once.
Finished run_one(const PlanChoice& choice, const RunOptions& options,
                 const Composition& composition, const ProgressSink& progress,
                 const Company* company = nullptr);

}  // namespace whirl::cli

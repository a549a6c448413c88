// A scenario run through the judging, and whether that said what is right.
#pragma once
#include <string>

#include "harness/executive/run.hpp"
#include "harness/tests/oracle/scenario.hpp"
#include "results/report.hpp"

namespace whirl::oracle {

// Writes the plan to `file`, loads it and runs it in a world and on a target that play the scenario.
results::Report run_scenario(const Scenario& scenario, const std::string& file,
                             const ProgressSink& progress = nullptr);

// What is wrong with the report; empty: nothing.
std::string complaint(const Outcome& right, const results::Report& report);

// The plan as a user would write it.
std::string plan_text(const Scenario& scenario);

}  // namespace whirl::oracle

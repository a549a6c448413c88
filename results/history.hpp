// What earlier runs measured: results/history.sqlite, one row per expectation and run.
#pragma once
#include <string>
#include <vector>

#include "harness/base/result.hpp"
#include "results/report.hpp"

namespace whirl::results {

struct PastExpectation {
  std::string when;  // host time of the run
  std::string plan, name, verdict, unit, seed;
  double measured = 0, margin = 0;  // NaN: could not be measured
};

Result<Done> remember(const std::string& file, const Report& report);

// The last `runs` runs of each expectation that matches, oldest first; empty texts match all.
Result<std::vector<PastExpectation>> recall(const std::string& file, const std::string& plan,
                                            const std::string& expectation, int runs);

}  // namespace whirl::results

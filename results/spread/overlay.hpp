// What the runs of a plan recorded, laid over: each signal that an expectation was measured on, in the time
// in which it was, a thin line per seed, with their mean and one standard deviation about it.
//
//   Time     since the window's beginning, which each run has at its own time
//   Points   some hundreds of a window, each the mean of its stretch; of windows of different lengths as
//            many as all have
//   Errors   bad_input: the messages of a run cannot be read
#pragma once
#include <vector>

#include "base/result.hpp"
#include "results/charts.hpp"
#include "results/spread/spread.hpp"

namespace whirl::results {

inline constexpr std::size_t kMost_overlays = 60;  // of one page

// Runs without a folder are left out. Of more windows than that the first.
Result<std::vector<Chart>> overlays(const std::vector<const SeedRun*>& runs);

}  // namespace whirl::results

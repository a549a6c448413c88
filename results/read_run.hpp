// A report from its run.json, for who merges runs of other processes: their JUnit cases and their line in the
// history. Figures that only a page shows (tasks, histograms, samples) stay in the file.
#pragma once
#include <string_view>

#include "base/result.hpp"
#include "results/report.hpp"

namespace whirl::results {

// Errors  internal: not a run.json of ours; a value that is missing or of another type is named with its key,
//         "expectations[2].measured"
Result<Report> read_run(std::string_view json_text);

}  // namespace whirl::results

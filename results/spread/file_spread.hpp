// The files of a plan's spread over seeds: FOLDER/PLAN.html and FOLDER/PLAN.csv.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "results/spread/spread.hpp"

namespace whirl::results {

// name: of the files, without ending; spread: of these runs. Returns the page's path.
// Errors  host: the folder or a file cannot be written; bad_input: a run's messages cannot be read
Result<std::string> file_spread(const std::string& folder, const std::string& name,
                                const Spread& spread, const std::vector<const SeedRun*>& runs);

}  // namespace whirl::results

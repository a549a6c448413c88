// Which plans a command speaks of.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/cli/options.hpp"

namespace whirl::cli {

struct PlanChoice {
  std::string file;
  std::string name;
  std::vector<std::string> tags;
  std::string image, vehicle;  // for people
  std::int64_t timeout_ns = 0;
  std::optional<std::uint64_t> seed = {};  // of this run; nothing: the plan's own
};

// Lua files below the given paths that declare plans. Files in folders of parts (batteries, boards,
// propellers and so on: is_data_folder) are data. An unreadable or wrong file is an Error in the list, not the end of it.
struct FoundPlans {
  std::vector<PlanChoice> plans;
  std::vector<Error> errors;
};
FoundPlans find_plans(const RunOptions& options, const std::string& root);

// Relative to where the user stands, when it lies below; so that messages stay short.
std::string shown_path(const std::string& path);

}  // namespace whirl::cli

// What a data file says it is: kind = "vehicle", "propeller", ... ; empty where it says nothing.
#pragma once
#include <string>

#include "base/result.hpp"

namespace whirl::catalogue {

Result<std::string> read_kind(const std::string& path);

}  // namespace whirl::catalogue

// What a data file says it is: kind = "vehicle", "propeller", ... ; empty where it says nothing.
#pragma once
#include <string>

#include "base/result.hpp"

namespace whirl::catalogue {

Result<std::string> read_kind(const std::string& path);

// What is said of a file whose kind has neither curves nor copies.
Error no_part(const std::string& path);

}  // namespace whirl::catalogue

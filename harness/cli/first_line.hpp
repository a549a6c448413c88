// The first line that a command prints; empty where it cannot be run or fails.
#pragma once
#include <string>

namespace whirl::cli {

std::string first_line(const std::string& command);

}  // namespace whirl::cli

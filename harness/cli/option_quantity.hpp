// An option that is a quantity within bounds which its user is told.
#pragma once
#include <string>

#include "base/result.hpp"
#include "base/units.hpp"

namespace whirl::cli {

// Nothing was written: `into` stays. low and high are quantities as a user writes them.
// Errors  bad_input: none of that dimension, or outside the bounds
Result<Done> read_within(const std::string& text, Dimension dimension, const char* option,
                         const char* low, const char* high, double& into);

}  // namespace whirl::cli

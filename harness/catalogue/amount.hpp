// A quantity of a part that a file may give as it is ("90 mohm") or relative to the part's own ("+12 %").
#pragma once
#include <string_view>

#include "harness/lua/table.hpp"

namespace whirl::catalogue {

// In SI. A share is of own_SI, from -95 % to 1000 %; the range is of what stands there as it is.
// Complaints stay with the table. Pre: t.has(key).
double read_amount(const lua::Table& t, std::string_view key, Dimension dimension, double own_SI,
                   lua::Range range);

}  // namespace whirl::catalogue

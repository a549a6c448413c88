// What one t:command may not ask at once.
#pragma once
#include <vector>

#include "harness/lua/table.hpp"
#include "harness/world/request.hpp"

namespace whirl::plan {

// Refuses the second way to fly, or to turn a motor, by its key.
void refuse_contradictions(const lua::Table& t, const std::vector<Command>& all);

}  // namespace whirl::plan

// The key `tolerance` of stands and vehicles: one class, or one by group.
//
//   tolerance = "typical"
//   tolerance = { dividers = "worst", rest = "typical" }     -- without `rest`: none
#pragma once
#include <span>

#include "harness/lua/table.hpp"
#include "plant/parts/part_number.hpp"

namespace whirl::catalogue {

// Complaints stay with the table.
plant::Tolerances read_tolerance(const lua::Table& t, std::span<const char* const> groups);

}  // namespace whirl::catalogue

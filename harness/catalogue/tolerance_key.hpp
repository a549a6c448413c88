// The key `tolerance` of stands and vehicles: one class, or one by group.
//
//   tolerance = "typical"
//   tolerance = { dividers = "worst", rest = "typical" }     -- without `rest`: none
//   Unsaid   a stand is a copy out of the bag, a vehicle what its file draws
#pragma once
#include <span>

#include "harness/lua/table.hpp"
#include "plant/parts/part_number.hpp"

namespace whirl::catalogue {

// Complaints stay with the table. unsaid: of all groups where there is no such key.
plant::Tolerances read_tolerance(const lua::Table& t, std::span<const char* const> groups,
                                 plant::ToleranceClass unsaid);

}  // namespace whirl::catalogue

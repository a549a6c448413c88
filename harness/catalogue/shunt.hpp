// The current sense of an ESC as vehicles and stands write it, where it differs from the plant's own:
//
//   shunt = { gain = "+5 %", offset = "4.3 A", noise = "20 mA", warm_up = "0.4 A", wander = "10 mA" }
//   gain             this part's error, known; nothing is drawn then
//   gain_tolerance   or the bound of what is drawn for each part
//   noise            standard deviation at any current
#pragma once
#include "harness/lua/table.hpp"
#include "plant/sensors/current_shunt.hpp"

namespace whirl::catalogue {

// Complaints stay with the table.
plant::CurrentShuntParams read_shunt(const lua::Table& t);

}  // namespace whirl::catalogue

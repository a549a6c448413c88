// A pack's own file, as one writes it from a discharge of a cell and a data sheet:
//
//   return {
//     kind = "battery", name = "...", cells = 4, parallel = 1,
//     capacity = "2340 mAh",                                -- what follows is of one cell
//     open_circuit = { { used = 0, V = 4.18 }, ..., { used = 1, V = 3.07 } },
//     resistance = "35 mohm",                               -- at once
//     relaxation = { { resistance = "5 mohm", time = "16 s" }, { resistance = "68 mohm", time = "209 s" } },
//     resistance_over_charge = { { used = 0, factor = 1 }, ... },               -- of all three
//     resistance_over_temperature = { { celsius = 0, factor = 2.1 }, ... },     -- likewise
//   }
//   Refuses  curves that rise or do not run from 0 to 1, no cells, what a Battery refuses
//            (plant/battery/battery_params.hpp)
#pragma once
#include <string>

#include "base/result.hpp"
#include "plant/battery/battery_params.hpp"

namespace whirl::catalogue {

Result<plant::BatteryParams> read_battery_file(const std::string& path);

}  // namespace whirl::catalogue

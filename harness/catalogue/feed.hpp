// What feeds a vehicle or a stand: a pack or a laboratory supply, one of the two.
//
//   battery = "4s_2200", or
//   battery = { pack = "4s_2200", capacity = "2200 mAh", resistance = "30 mohm",
//               depth_of_discharge = "20 %", share = "25 %" }
//   battery = { file = "../batteries/NAME.lua", temperature = "5 degC", ... }: a pack of its own
//   (battery_file.hpp), beside the file that names it; the other keys as above
//   supply = "16 V", or supply = { voltage = "16 V", resistance = "10 mohm" }
//   Share    how much of the pack is there for who reads it: one motor of four feels a quarter of it
//            as a vehicle's motor does, since the others draw the rest
#pragma once
#include "harness/lua/table.hpp"
#include "plant/battery/battery_params.hpp"

namespace whirl::catalogue {

// Reads the keys `battery` and `supply` of t; complaints stay with it.
plant::BatteryParams read_feed(const lua::Table& t);

}  // namespace whirl::catalogue

// The motor and the current sensor behind the board's power stage, where a plan's stand differs from
// the board's own.
//
//   motor = { inertia = "+12 %", resistance = "90 mohm", inductance = "45 uH",
//             no_load_current = "1 A", kv_rpm_per_V = 950 },
//   shunt = { gain = "+5 %", offset = "4.3 A", noise = "20 mA", warm_up = "0.4 A", wander = "10 mA" }
//   Relative "+12 %" and "-12 %" are of the plant's own motor (plant/motor/motor_params.hpp)
//   Reaches  the board's process as parameters of its power_stage (board/power_stage.hpp)
#pragma once
#include <map>
#include <string>

#include "base/result.hpp"
#include "harness/lua/table.hpp"

namespace whirl::stand {

using StageParams = std::map<std::string, double>;  // SI, by the power stage's own names

// Reads the keys `motor` and `shunt` where they are there; complaints stay with the table.
StageParams read_stage(const lua::Table& stand);

// The board's description with these parameters at the power stage of that motor. Refused where the
// board has no such stage.
Result<std::string> with_stage(const std::string& board_json, int motor, const StageParams& params);

}  // namespace whirl::stand

// The motor and the current sensor behind the board's power stage, where a plan's stand differs from
// the board's own.
//
//   Reaches  the board's process as parameters of its power_stage (io_bridges/rack/devices/power_stage.cpp)
#pragma once
#include <map>
#include <string>

#include "base/result.hpp"
#include "io_bridges/board_description/board_description.hpp"
#include "plant/motor/motor_params.hpp"
#include "plant/sensors/current_shunt.hpp"

namespace whirl::stand {

using StageParams = std::map<std::string, double>;  // SI, by the power stage's own names

// Gives these parameters to the power stage of that motor. Refused where the board has no such stage.
Result<Done> set_stage(BoardDescription& board, int motor, const StageParams& params);

// The same as the plant's own parameters, for who computes with them on the host; what a stage has no name
// for is the plant's own, but a winding has no more resistance than the whole.
plant::MotorParams motor_of(const StageParams& params);
plant::CurrentShuntParams shunt_of(const StageParams& params);
// And back: a motor, and a current sense that is drawn from its tolerances.
StageParams stage_of(const plant::MotorParams& motor, const plant::CurrentShuntParams& shunt);

}  // namespace whirl::stand

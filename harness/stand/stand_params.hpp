// What a thrust stand is made of: what turns, what feeds it, what commands it.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "harness/stand/esc_master.hpp"
#include "harness/stand/stage_params.hpp"
#include "plant/battery/battery_params.hpp"
#include "plant/rotor/blade.hpp"
#include "plant/sensors/load_cell.hpp"

namespace whirl::stand {

struct StandParams {
  std::shared_ptr<const plant::Blade> blade;
  plant::BatteryParams battery;
  plant::LoadCellParams cell;
  StageParams stage;  // what differs from the board's own motor and shunt
  EscMasterParams esc;
  bool commands = true;  // false: somebody else commands the ESC (whirl standin)
};

}  // namespace whirl::stand

// What a thrust stand is made of: what turns, what feeds it, what commands it.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/stand/esc_master.hpp"
#include "harness/stand/stage_params.hpp"
#include "harness/world/drawn_part.hpp"
#include "plant/air/atmosphere.hpp"
#include "plant/battery/battery_params.hpp"
#include "plant/parts/part_number.hpp"
#include "plant/rotor/blade.hpp"
#include "plant/rotor/rotor.hpp"
#include "plant/sensors/load_cell.hpp"
#include "plant/sensors/meter.hpp"

namespace whirl::stand {

struct StandParams {
  std::shared_ptr<const plant::Blade> blade;
  std::vector<std::string> doubts;       // of its propeller's file
  std::optional<plant::Atmosphere> air;  // none: 1.225 kg/m3, as propellers' tables are reduced to
  plant::BatteryParams battery;
  plant::LoadCellParams cell;
  plant::MeterParams ammeter, voltmeter;  // in the supply's lead
  plant::MeterParams anemometer;
  StageParams stage;                        // what differs from the board's own motor and shunt
  double hse_error = 0.0, hsi_error = 0.0;  // of the board's clocks, beside what its file says
  plant::Tolerances tolerance;              // by group: plant/parts/esc_stand.hpp
  std::vector<DrawnPart> drawn;             // what came of it (stand_parts.hpp)
  EscMasterParams esc;
  bool commands = true;  // false: somebody else commands the ESC (whirl standin)

  // Of a rotor at rest in that air.
  plant::RotorConditions still() const {
    plant::RotorConditions c;
    if (air) c.density_kgpm3 = air->density_kgpm3, c.viscosity_Pas = air->viscosity_Pas;
    return c;
  }
};

}  // namespace whirl::stand

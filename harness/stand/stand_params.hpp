// What a thrust stand is made of: what turns, what feeds it, what commands it.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "harness/stand/stage_params.hpp"
#include "io_bridges/protocols/esc_codec.hpp"
#include "plant/battery/battery_params.hpp"
#include "plant/rotor/blade.hpp"
#include "plant/sensors/load_cell.hpp"

namespace whirl::stand {

struct StandParams {
  std::shared_ptr<const plant::Blade> blade;
  plant::BatteryParams battery;
  plant::LoadCellParams cell;
  StageParams stage;  // what differs from the board's own motor and shunt
  io::EscMode mode = io::EscMode::thrust_by_rpm;
  std::uint8_t address = 0x29;
  double pulse_rate_Hz = 0.0;  // of the throttle's pulses; 0: it writes over I2C
  std::uint16_t i2c = 2, serial = 1, motor = 1;
};

}  // namespace whirl::stand

// A thrust stand as a plan names it: what turns, what feeds it, what commands it.
//
//   stand = { prop = "hk_10x4.5", battery = "4s_2200", depth_of_discharge = "0 %",
//             battery_share = "25 %" }  or
//   stand = { prop = "hk_10x4.5", supply = "16 V", supply_resistance = "10 mohm",
//             mode = "thrust_by_rpm", address = 0x29, i2c = 2, serial = 1 }
//   and optionally motor = { ... }, shunt = { ... }: stage_params.hpp
//   Throttle throttle = "i2c" (set-points at 50 Hz), or "pwm" (pulse_rate = "50 Hz" to "400 Hz"; the
//            status is read over I2C all the same)
//   Mode     what the ESC is set to: it scales the set-points on I2C (esc_codec.hpp)
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "base/result.hpp"
#include "harness/lua/table.hpp"
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

// Propellers are looked for in this folder.
Result<StandParams> read_stand(const lua::Table& table, const std::string& propellers);

}  // namespace whirl::stand

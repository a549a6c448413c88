// A thrust stand as plans and calibrations write it: what turns, what feeds it, what commands it.
//
//   stand = { prop = "hk_10x4.5", battery = "4s_2200", mode = "thrust_by_rpm",
//             address = 0x29, i2c = 2, serial = 1 }
//   and optionally motor = { ... }, shunt = { ... }: where the board's own differ (motor.hpp, shunt.hpp;
//   motor = { swap_wires = true }: two of its wires)
//   Feed     battery or supply: feed.hpp
//   Air      air = { temperature = "35 degC", above_sea = "500 m" } (place_air.hpp): it cools the motor as well. Where it is
//            not said: 1.225 kg/m3, and a motor cooled as the board's power stage says
//   Throttle throttle = "i2c" (set-points at 50 Hz), or "pwm" (pulse_rate = "50 Hz" to "400 Hz"; the
//            status is read over I2C all the same)
//   Mode     what the ESC is set to: it scales the set-points on I2C (esc_codec.hpp)
#pragma once
#include <string>

#include "base/result.hpp"
#include "harness/lua/table.hpp"
#include "harness/stand/stand_params.hpp"

namespace whirl::catalogue {

// Propellers are looked for in this folder. Reads and finishes the whole document.
Result<stand::StandParams> read_stand(const lua::Table& table, const std::string& propellers);

}  // namespace whirl::catalogue

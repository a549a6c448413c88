// A motor as vehicles and stands write it, line to line:
//
//   motor = { kv_rpm_per_V = 950, resistance = "120 mohm", inductance = "20 uH",
//             winding_resistance = "70 mohm", no_load_current = "1 A", inertia = "3.752e-5 kg m2",
//             pole_pairs = 7, resistance_fitted_at = "5000 rpm" }
//   Shares   "+12 %" and "-12 %" are of the plant's own motor (plant/motor/motor_params.hpp), or of the file's
//   File     motor = { file = "../motors/NAME.lua" }: that motor (motor_file.hpp), but for the keys beside it
//   Fitted   a resistance read from a running motor holds what commutation looks like at that speed:
//            (3/pi) w_e (L/2) is taken out of it
#pragma once
#include "harness/lua/table.hpp"
#include "plant/motor/motor_params.hpp"

namespace whirl::catalogue {

enum class MissingKeys {
  refused,      // a motor of its own; inductance, winding and pole pairs may stay away
  as_in_plant,  // the plant's own motor, but for the keys that are there
};

// Complaints stay with the table.
plant::MotorParams read_motor(const lua::Table& t, MissingKeys missing);

}  // namespace whirl::catalogue

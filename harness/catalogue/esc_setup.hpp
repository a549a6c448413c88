// A vehicle's ESCs as its file writes them: what the control core is told, and its current sensor.
//
//   esc = { mode = "thrust_by_rpm", max_current = "20 A", brake_current = "15 A",
//           arming_voltage = "15.7 V", still_air = { thrust = "2.2 N", warm_up = "60 s" }, calibration = { file = "...", kt = 0.01005 }, shunt = { ... } }
//   Calibration  names and SI numbers of the image's `set` (firmware/esc/core/parameters.hpp); a file
//                is what a stand has found (kind = "esc_calibration"), and what stands beside it wins
#pragma once
#include <optional>

#include "harness/flight/flight_params.hpp"
#include "harness/lua/table.hpp"

namespace whirl::catalogue {

// Complaints stay with the table. Pole pairs are the motor's, not read here.
flight::EscParams read_esc(const lua::Table& t);
// How each is told what still air takes; nothing: the file does not ask for it. Refused of an ESC that nobody has calibrated.
std::optional<flight::StillAirRun> read_still_air(const lua::Table& t,
                                                  const fw::esc::Calibration& calibration);

}  // namespace whirl::catalogue

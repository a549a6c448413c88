// A vehicle as a Lua file (test_plans/vehicles): airframe, propeller, motor, pack, ESC, capture system.
//
//   Errors   bad_input, with the file's line: what the first complaint is about
#pragma once
#include <string>

#include "base/result.hpp"
#include "base/setting.hpp"
#include "harness/flight/flight_params.hpp"

namespace whirl::catalogue {

// settings: those of "vehicle." take the place of what the file says.
Result<flight::FlightParams> read_vehicle(const std::string& path, const Settings& settings = {});

}  // namespace whirl::catalogue

// The thrust stand of a calibration file as a drive that can be computed: one motor with its propeller on its feed.
//
//   Motor  the plant's own but for what the stand's table says
//   ESC    the usual one; what of it the stand's table says (address, mode) plays no part
#pragma once
#include <string>

#include "base/result.hpp"
#include "harness/flight/flight_params.hpp"

namespace whirl::catalogue {

Result<flight::FlightParams> read_stand_drive(const std::string& calibration,
                                              const std::string& propellers);

}  // namespace whirl::catalogue

// Before a flight the vehicle's crew holds it in still air, lets one motor after the other run at a thrust of
// hover and types `still` to its ESC (firmware/esc/core/still_air.hpp): what each motor and propeller of this very
// copy takes, in the air of this day, is then its still air's power.
//
//   Rig      that motor, rotor and pack alone, out of ground effect, in the air over the vehicle's place: averaged
//            motor and native core as in flight; the shunt is the one that flies
//   Course   armed, warm_up at that thrust by speed, then `still`. Friction falls by some percent of power while grease
//            warms up, so the vehicle takes off at once: a copy's motors begin the flight as warm as this left them.
//            What that takes of the pack is not counted
//   Errors   an ESC that refuses, with its motor's number: a fault of the file's thrust or calibration
#pragma once
#include <cstdint>

#include "base/result.hpp"
#include "harness/flight/flight_params.hpp"

namespace whirl::flight {

// Does nothing without params.still_air; else fills in params.calibrations and tells of each motor in params.drawn
// what it found. Pre: draw_parts() has been here.
Result<Done> tell_still_air(FlightParams& params, std::uint64_t seed);

}  // namespace whirl::flight

// One copy of a vehicle: draws what plant/parts/vehicle.hpp lists and puts it where it belongs, into motors,
// rotors, body and the IMU of the board. What ESCs and flight controller believe stays the file's.
//
//   IMU      what the board's file states of its spread is that part's and stays; place and turn are what the copy is
//            off from there
//   Centre   the centre of mass lies off the drawing's: rotors, feet and the IMU are moved against it
//   Order    draw_parts() on the vehicle, then set_parts() on the board that flies it
#pragma once
#include <cstdint>

#include "harness/flight/flight_params.hpp"
#include "io_bridges/board_description/board_description.hpp"

namespace whirl::flight {

void draw_parts(FlightParams& params, std::uint64_t seed);
void set_parts(BoardDescription& board, const FlightParams& params);

}  // namespace whirl::flight

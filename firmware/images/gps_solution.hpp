// What a receiver says, on its UART or as a node on CAN, as the flight's own solution.
//
//   Age   from the epoch that the solution is of: the receiver's own latency and since it came
#pragma once
#include "firmware/drivers/can_sensors.hpp"
#include "firmware/drivers/ublox_gps.hpp"
#include "firmware/flight/flight.hpp"

namespace fw {

GpsSolution solution_of(const GpsFix& fix);
GpsSolution solution_of(const CanFix& fix);

}  // namespace fw

// The flight image's node on CAN2: one reader of what comes, for the ESCs, the sensors and whoever asks.
#pragma once
#include "firmware/config/parameter_access.hpp"
#include "firmware/drivers/can_sensors.hpp"
#include "firmware/drivers/esc_can.hpp"
#include "firmware/flight/flight.hpp"
#include "firmware/hal/can_link.hpp"

namespace fw {

using FlightCan = hal::BxCan<hal::HeaderCan>;
using FlightCanEscs = EscCan<FlightCan, ParameterAccess>;

FlightCanEscs& can_escs();
CanSensors& can_sensors();

// Once a parameter asks for it; the bus stays on from then. True: it is on.
bool start_can(Flight& flight);
// In each tick: hands on what came, and tells NodeStatus once a second.
void can_tick(const Flight& flight, std::uint32_t tick, std::uint32_t now_us,
              std::uint32_t uptime_s);

}  // namespace fw

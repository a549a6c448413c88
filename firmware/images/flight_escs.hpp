// The flight image's ESCs, on I2C3 or on CAN2: the parameter ESC_BUS says which.
#pragma once
#include <cstdint>

#include "firmware/flight/flight.hpp"
#include "firmware/status.hpp"

namespace fw {

// Hands on what the ESCs told since the last time, then does what is due in this tick. True: set-points
// went out.
bool serve_escs(Flight& flight, Faults& faults, std::uint32_t tick);

}  // namespace fw

// Every frame on a CAN bus becomes a message, good or not.
#pragma once
#include "io_bridges/devices/can_bus.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::rack {

// Pre: `happened` outlives the bus.
void log_can(io::CanBus& bus, int number, io::Batch& happened);

}  // namespace whirl::rack

// The keys of a telemetry radio, of a board's own and of one that a pod plays.
#pragma once
#include <vector>

#include "io_bridges/devices/mavlink_link.hpp"
#include "io_bridges/rack/device_type.hpp"

namespace whirl::rack {

std::vector<DeviceKey> air_keys();  // params.uplink_loss, .downlink_loss, .air_bytes_per_s, .buffer
// Pre: the slot's type has those keys.
io::MavlinkLink::Params radio_of(DeviceSlot& slot, double baud);

}  // namespace whirl::rack

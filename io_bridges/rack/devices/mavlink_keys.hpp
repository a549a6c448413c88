// What a telemetry radio of a board's own and one that a pod plays have in common: keys, and what they tell.
#pragma once
#include <vector>

#include "io_bridges/devices/mavlink_link.hpp"
#include "io_bridges/rack/device_type.hpp"

namespace whirl::rack {

std::vector<DeviceKey> air_keys();  // params.uplink_loss, .downlink_loss, .air_bytes_per_s, .buffer
// Pre: the slot's type has those keys.
io::MavlinkLink::Params radio_of(DeviceSlot& slot, double baud);
// What the radio carries down, and what has reached the MCU, go to `happened` under that port. Both must live as long.
void tell_frames(io::MavlinkLink& radio, io::Batch& happened, std::uint16_t port);

}  // namespace whirl::rack

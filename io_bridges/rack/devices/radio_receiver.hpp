// What the devices of radio-control receivers have in common: the keys of their link, and how a message
// becomes stick positions.
#pragma once
#include <vector>

#include "io_bridges/devices/radio_link.hpp"
#include "io_bridges/rack/device_type.hpp"

namespace whirl::rack {

void add_link_keys(std::vector<DeviceKey>& keys);
io::RadioLink::Params link_of(const DeviceSlot& slot);
io::StickPositions sticks_of(const io::Reader& message);

}  // namespace whirl::rack

// What every device that is a DroneCAN node of a board's bus is told.
#pragma once
#include "io_bridges/devices/dronecan_node.hpp"
#include "io_bridges/rack/device_type.hpp"

namespace whirl::rack {

// bus, params.node and params.rate. `node_text`: the node id that is taken where none is given.
std::vector<DeviceKey> can_node_keys(const std::string& node_text);
io::DroneCanNode::Setup can_node_of(DeviceSlot& slot, const std::string& info, int usual_node);

}  // namespace whirl::rack

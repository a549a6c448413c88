#include "io_bridges/rack/devices/can_node_keys.hpp"

namespace whirl::rack {

std::vector<DeviceKey> can_node_keys(const std::string& node_text) {
  DeviceKey node{.path = "params.node", .about = "its node id", .kind = KeyKind::whole};
  node.limits = {1, 125};
  return {
      bus_key("can", "the bus").need(), node.with_text(node_text),
      quantity_key("params.rate", Dimension::frequency, "kHz", {10e3, 1e6}, "of bits").with(1e6)};
}

io::DroneCanNode::Setup can_node_of(DeviceSlot& slot, const std::string& info, int usual_node) {
  return {.name = slot.name(),
          .info = info,
          .number = slot.number(),
          .node_id = static_cast<std::uint8_t>(slot.given("params.node") ? slot.whole("params.node")
                                                                         : usual_node),
          .rate_Hz = slot.quantity("params.rate")};
}

}  // namespace whirl::rack

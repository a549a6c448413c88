#include "io_bridges/rack/devices/battery_divider.hpp"

#include "io_bridges/rack/models/sense_line.hpp"

namespace whirl::rack {
namespace {

double drawn_ohm(DeviceSlot& slot, const char* path) {
  return drawn_resistance_ohm(slot.quantity(path), slot.quantity("params.tolerance"),
                              slot.rack().seed(), slot.name() + "." + path);
}

}  // namespace

std::vector<DeviceKey> divider_keys() {
  const auto resistor = [](const char* path, double usual_ohm, const char* about) {
    return quantity_key(path, Dimension::resistance, "ohm", {1.0, 10e6}, about).with(usual_ohm);
  };
  return {resistor("params.top", 47e3, "from the battery"),
          resistor("params.bottom", 10e3, "to ground"),
          quantity_key("params.tolerance", Dimension::ratio, "%", {0.0, 0.2},
                       "of each resistor, drawn evenly")
              .with(0.01)};
}

BatteryDivider::BatteryDivider(DeviceSlot& slot)
    : top_ohm_(drawn_ohm(slot, "params.top")), bottom_ohm_(drawn_ohm(slot, "params.bottom")) {}

}  // namespace whirl::rack

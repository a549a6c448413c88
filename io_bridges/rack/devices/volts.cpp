// A level on an analog pin.
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

class VoltsDevice final : public RackDevice {
 public:
  explicit VoltsDevice(DeviceSlot& slot) {
    slot.set_analog(slot.text("bus"),
                    [level_V = slot.quantity("params.volts")](Nanoseconds) { return level_V; });
  }
};

}  // namespace

DeviceType volts_type() {
  return {"volts",
          "level on an analog pin",
          {pin_key("bus", "the pin").need(),
           quantity_key("params.volts", Dimension::voltage, "V", {-0.3, 5.5}, "the level").need()},
          make_device<VoltsDevice>};
}

}  // namespace whirl::rack

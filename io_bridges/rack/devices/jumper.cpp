// A wire with a direction: one pin's level, driven onto another.
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

class JumperDevice final : public RackDevice {
 public:
  explicit JumperDevice(DeviceSlot& slot) {
    io::Wire &from = slot.pin("cs"), &to = slot.pin("int");
    const int driver = to.add_driver(slot.name());
    const auto copy = [&to, driver](bool level, Nanoseconds now) {
      to.drive(driver, level ? io::Drive::high : io::Drive::low, now);
    };
    copy(from.level(), 0);
    from.watch(copy);
  }
};

}  // namespace

DeviceType jumper_type() {
  return {"jumper",
          "copies the level of one pin to another",
          {{.path = "bus", .about = "no bus: two pins", .kind = KeyKind::word, .unit = "pins"},
           pin_key("cs", "the pin it copies").need().own(Sharing::shared),
           pin_key("int", "the pin it drives").need()},
          make_device<JumperDevice>};
}

}  // namespace whirl::rack

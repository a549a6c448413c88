// The servo output of a radio receiver on a throttle pin.
#include "io_bridges/devices/pulse_source.hpp"

#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

class PulseDevice final : public RackDevice {
 public:
  explicit PulseDevice(DeviceSlot& slot)
      : motor_(slot.whole("motor")), source_(slot.rack().events(), slot.pin("bus"), slot.name()) {}

  std::vector<Intake> intakes() const override { return {{io::Kind::pulse_train, motor_}}; }
  void on_message(const io::Reader& message) override {
    const auto t = message.as<io::PulseTrain>();
    source_.set({t.width_ns, t.period_ns, t.glitch_ns, t.glitch_after_ns});
  }

 private:
  std::uint16_t motor_;
  io::PulseSource source_;
};

}  // namespace

DeviceType pulse_source_type() {
  return {"pulse_source",
          "throttle pulses of a receiver on a pin",
          {pin_key("bus", "the pin that it drives").need(), motor_key().need()},
          make_device<PulseDevice>};
}

}  // namespace whirl::rack

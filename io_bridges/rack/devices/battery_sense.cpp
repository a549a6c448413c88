// The battery's voltage at an ADC pin: a divider with a capacitor at its tap.
//
//   Faults   sensor_offset (value V that the divider sees more, never below 0: a wire that is off sees none)
#include <algorithm>

#include "io_bridges/rack/devices/battery_divider.hpp"
#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/rack/models/sense_line.hpp"

namespace whirl::rack {
namespace {

class BatterySenseDevice final : public RackDevice {
 public:
  explicit BatterySenseDevice(DeviceSlot& slot)
      : divider_(slot),
        line_(line_of(slot)),
        faults_(&slot.rack().faults()),
        number_(slot.number()) {
    line_.set_V(divider_.tap_V(io::BodyMotion{}.bus_voltage_V), slot.rack().events().now());
    slot.set_analog(slot.text("bus"), [this](Nanoseconds now) { return line_.sample_V(now); });
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override {
    const io::Nanoseconds now = message.header().t_ns;
    double battery_V = message.as<io::BodyMotion>().bus_voltage_V;
    const io::Fault* offset =
        faults_->apply(io::FaultKind::sensor_offset, io::kAnywhere, number_, now);
    if (offset != nullptr) battery_V = std::max(battery_V + offset->value, 0.0);
    line_.set_V(divider_.tap_V(battery_V), now);
  }

 private:
  SenseLine::Params line_of(DeviceSlot& slot) const {
    return {.time_constant_s = divider_.source_ohm() * slot.quantity("params.capacitance"),
            .noise_V = slot.quantity("params.noise"),
            .seed = slot.rack().seed(),
            .name = slot.name()};
  }

  BatteryDivider divider_;
  SenseLine line_;
  io::FaultBook* faults_;
  int number_;
};

}  // namespace

DeviceType battery_sense_type() {
  std::vector<DeviceKey> keys = {pin_key("bus", "the pin").need()};
  for (DeviceKey& key : divider_keys()) keys.push_back(std::move(key));
  keys.push_back(quantity_key("params.capacitance", Dimension::none, "F", {0.0, 1e-3},
                              "at the pin, a bare number")
                     .with(1e-7));
  keys.push_back(
      quantity_key("params.noise", Dimension::voltage, "mV", {0.0, 1.0}, "RMS at the pin")
          .with(1e-3));
  return {"battery_sense", "battery voltage on an analog pin, by a divider", std::move(keys),
          make_device<BatterySenseDevice>};
}

}  // namespace whirl::rack

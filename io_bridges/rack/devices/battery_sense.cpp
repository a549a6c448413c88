// The battery's voltage at an ADC pin: a divider with a capacitor at its tap. What the firmware knows is
// the nominal ratio; the resistors are drawn from their tolerance.
//
//   Faults   sensor_offset (value V that the divider sees more, never below 0: a wire that is off sees none)
#include <algorithm>

#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/rack/models/sense_line.hpp"

namespace whirl::rack {
namespace {

class BatterySenseDevice final : public RackDevice {
 public:
  explicit BatterySenseDevice(DeviceSlot& slot)
      : divider_(divider_of(slot)),
        line_(line_of(slot)),
        faults_(&slot.rack().faults()),
        number_(slot.number()) {
    line_.set_V(tap_V(io::BodyMotion{}.bus_voltage_V), slot.rack().events().now());
    slot.set_analog(slot.text("bus"), [this](Nanoseconds now) { return line_.sample_V(now); });
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override {
    const io::Nanoseconds now = message.header().t_ns;
    double battery_V = message.as<io::BodyMotion>().bus_voltage_V;
    const io::Fault* offset =
        faults_->apply(io::FaultKind::sensor_offset, io::kAnywhere, number_, now);
    if (offset != nullptr) battery_V = std::max(battery_V + offset->value, 0.0);
    line_.set_V(tap_V(battery_V), now);
  }

 private:
  struct Divider {
    double top_ohm, bottom_ohm;
  };

  static Divider divider_of(DeviceSlot& slot) {
    const auto drawn = [&slot](const char* path) {
      return drawn_resistance_ohm(slot.quantity(path), slot.quantity("params.tolerance"),
                                  slot.rack().seed(), slot.name() + "." + path);
    };
    return {drawn("params.top"), drawn("params.bottom")};
  }
  SenseLine::Params line_of(DeviceSlot& slot) const {
    const double source_ohm =
        divider_.top_ohm * divider_.bottom_ohm / (divider_.top_ohm + divider_.bottom_ohm);
    return {.time_constant_s = source_ohm * slot.quantity("params.capacitance"),
            .noise_V = slot.quantity("params.noise"),
            .seed = slot.rack().seed(),
            .name = slot.name()};
  }
  double tap_V(double battery_V) const {
    return battery_V * divider_.bottom_ohm / (divider_.top_ohm + divider_.bottom_ohm);
  }

  Divider divider_;
  SenseLine line_;
  io::FaultBook* faults_;
  int number_;
};

}  // namespace

DeviceType battery_sense_type() {
  const auto resistor = [](const char* path, double usual_ohm, const char* about) {
    return quantity_key(path, Dimension::resistance, "ohm", {1.0, 10e6}, about).with(usual_ohm);
  };
  return {"battery_sense",
          "battery voltage on an analog pin, by a divider",
          {pin_key("bus", "the pin").need(), resistor("params.top", 47e3, "from the battery"),
           resistor("params.bottom", 10e3, "to ground"),
           quantity_key("params.tolerance", Dimension::ratio, "%", {0.0, 0.2},
                        "of each resistor, drawn evenly")
               .with(0.01),
           quantity_key("params.capacitance", Dimension::none, "F", {0.0, 1e-3},
                        "at the pin, a bare number")
               .with(1e-7),
           quantity_key("params.noise", Dimension::voltage, "mV", {0.0, 1.0}, "RMS at the pin")
               .with(1e-3)},
          make_device<BatterySenseDevice>};
}

}  // namespace whirl::rack

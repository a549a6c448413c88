// The battery's current at an ADC pin: a shunt with its amplifier, or a Hall sensor. Gain and offset are
// drawn about what their data sheet says.
//
//   Left out  bandwidth of the sensor beside its RC, hysteresis of Hall sensors, drift with temperature
#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/rack/models/sense_line.hpp"

namespace whirl::rack {
namespace {

class CurrentSenseDevice final : public RackDevice {
 public:
  explicit CurrentSenseDevice(DeviceSlot& slot)
      : gain_V_per_A_(slot.quantity("params.gain") * (1.0 + drawn(slot, "params.tolerance"))),
        offset_V_(slot.quantity("params.offset") + drawn(slot, "params.offset_error")),
        line_({.time_constant_s = slot.quantity("params.time_constant"),
               .noise_V = slot.quantity("params.noise"),
               .seed = slot.rack().seed(),
               .name = slot.name()}) {
    line_.set_V(offset_V_, slot.rack().events().now());
    slot.set_analog(slot.text("bus"), [this](Nanoseconds now) { return line_.sample_V(now); });
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override {
    const double current_A = message.as<io::BodyMotion>().battery_current_A;
    line_.set_V(offset_V_ + gain_V_per_A_ * current_A, message.header().t_ns);
  }

 private:
  // Evenly between minus and plus the key's value.
  static double drawn(DeviceSlot& slot, const char* path) {
    RandomStream random(slot.rack().seed(), slot.name() + "." + path);
    return slot.quantity(path) * (2.0 * random.uniform() - 1.0);
  }

  double gain_V_per_A_, offset_V_;
  SenseLine line_;
};

}  // namespace

DeviceType current_sense_type() {
  return {"current_sense",
          "battery current on an analog pin",
          {pin_key("bus", "the pin").need(),
           quantity_key("params.gain", Dimension::none, "V/A", {-10.0, 10.0},
                        "of the sensor, a bare number")
               .need(),
           quantity_key("params.tolerance", Dimension::ratio, "%", {0.0, 0.5},
                        "of the gain, drawn evenly")
               .with(0.01),
           quantity_key("params.offset", Dimension::voltage, "V", {-0.3, 5.5}, "at no current")
               .with(0.0),
           quantity_key("params.offset_error", Dimension::voltage, "mV", {0.0, 1.0},
                        "drawn evenly about the offset")
               .with(5e-3),
           quantity_key("params.time_constant", Dimension::time, "ms", {0.0, 1.0},
                        "of the low-pass at the pin")
               .with(1e-3),
           quantity_key("params.noise", Dimension::voltage, "mV", {0.0, 1.0}, "RMS at the pin")
               .with(1e-3)},
          make_device<CurrentSenseDevice>};
}

}  // namespace whirl::rack

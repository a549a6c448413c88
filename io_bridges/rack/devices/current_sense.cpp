// The battery's current at an ADC pin: a shunt with its amplifier, or a Hall sensor. Gain and offset are
// drawn about what their data sheet says.
//
//   Faults    sensor_frozen (the sensor's output stays what it was), sensor_offset (A, of the current), sensor_drift
//             (A a minute), sensor_saturated (its output at the pin's supply). One whose wire is off shows 0 V: an
//             offset of -1 kA of a positive gain
//   Left out  bandwidth of the sensor beside its RC, hysteresis of Hall sensors, drift with temperature
#include <algorithm>

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
               .name = slot.name()}),
        faults_(&slot.rack().faults()),
        number_(slot.number()) {
    line_.set_V(offset_V_, slot.rack().events().now());
    slot.set_analog(slot.text("bus"), [this](Nanoseconds now) { return line_.sample_V(now); });
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override {
    const io::Nanoseconds now = message.header().t_ns;
    if (fails(io::FaultKind::sensor_frozen, now)) return;
    const double current_A = message.as<io::BodyMotion>().battery_current_A +
                             io::added_by_faults(faults_, io::kAnywhere, number_, now, 0);
    line_.set_V(fails(io::FaultKind::sensor_saturated, now)
                    ? SenseLine::Params{}.supply_V
                    : std::max(offset_V_ + gain_V_per_A_ * current_A, 0.0),
                now);
  }

 private:
  bool fails(io::FaultKind kind, io::Nanoseconds now) {
    return faults_->apply(kind, io::kAnywhere, number_, now) != nullptr;
  }
  // Evenly between minus and plus the key's value.
  static double drawn(DeviceSlot& slot, const char* path) {
    RandomStream random(slot.rack().seed(), slot.name() + "." + path);
    return slot.quantity(path) * (2.0 * random.uniform() - 1.0);
  }

  double gain_V_per_A_, offset_V_;
  SenseLine line_;
  io::FaultBook* faults_;
  int number_;
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

// Six switches, a motor and what the chip measures of it (models/power_stage.hpp), with the findings
// that it has to report.
#include "io_bridges/rack/models/power_stage.hpp"

#include <algorithm>

#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

constexpr const char* kPin_names[PowerStageParams::kPins] = {"a", "b", "c", "bus", "shunt"};

std::string of_pin(const char* what, std::size_t pin) {
  return std::string("params.adc.") + what + "." + kPin_names[pin];
}

// What makes one motor differ from the next of its kind, and warm.
void read_copy(const DeviceSlot& slot, plant::MotorParams& m) {
  m.winding_resistance_ohm = slot.quantity("params.winding_resistance");
  m.diode_drop_V = slot.quantity("params.diode_drop");
  m.heat_capacity_JpK = slot.quantity("params.heat_capacity");
  m.heat_resistance_KpW = slot.quantity("params.heat_resistance");
  m.ambient_temp_K = slot.quantity("params.ambient");
  m.start_temp_K = slot.given("params.start_temperature")
                       ? slot.quantity("params.start_temperature")
                       : m.ambient_temp_K;
  m.bearing_share = slot.quantity("params.bearing_share");
  m.phases.sine_share = slot.quantity("params.sine_share");
  m.phases.cogging_Nm = slot.quantity("params.cogging");
  for (std::size_t k = 0; k < 3; ++k) {
    m.phases.impedance[k] = slot.quantity(std::string("params.impedance.") + kPin_names[k]);
    m.phases.emf[k] = slot.quantity(std::string("params.emf.") + kPin_names[k]);
  }
}

void read_pins(const DeviceSlot& slot, PowerStageParams& p) {
  for (std::size_t pin = 0; pin < PowerStageParams::kPins; ++pin) {
    PinErrors& e = p.pins[pin];
    e.gain = slot.quantity(of_pin("gain", pin));
    e.offset_V = slot.quantity(of_pin("offset", pin));
    e.noise_V = slot.quantity(of_pin("noise", pin));
    if (pin == PowerStageParams::kShunt) continue;
    e.divider = slot.quantity(std::string("params.divider.") + kPin_names[pin]);
  }
}

PowerStageParams stage_params(const DeviceSlot& slot) {
  PowerStageParams p;
  read_copy(slot, p.motor);
  read_pins(slot, p);
  p.motor.torque_constant_NmpA = slot.quantity("params.torque_constant");
  p.motor.resistance_ohm = slot.quantity("params.resistance");
  p.motor.inductance_H = slot.quantity("params.inductance");
  p.motor.no_load_current_A = slot.quantity("params.no_load_current");
  p.motor.inertia_kgm2 = slot.quantity("params.inertia");
  p.motor.winding_resistance_ohm = std::min(p.motor.winding_resistance_ohm, p.motor.resistance_ohm);
  p.bus_capacitance_F = slot.quantity("params.bus_capacitance");
  p.bus_esr_ohm = slot.quantity("params.bus_esr");
  p.swap_wires = slot.flag("params.swap_wires");
  p.shunt.gain_tolerance = slot.quantity("params.shunt.gain");
  p.shunt.pole_Hz = slot.quantity("params.shunt.pole");
  p.shunt.warm_up_A = slot.quantity("params.shunt.warm_up");
  p.shunt.wander_A = slot.quantity("params.shunt.wander");
  if (slot.given("params.shunt.offset")) {
    p.shunt.offset_low_A = p.shunt.offset_high_A = slot.quantity("params.shunt.offset");
  }
  if (slot.given("params.shunt.gain_error")) {
    p.shunt.gain_error = slot.quantity("params.shunt.gain_error");
    p.shunt.gain_tolerance = 0.0;
  }
  if (slot.given("params.shunt.noise")) {
    p.shunt.noise_A = slot.quantity("params.shunt.noise");
    p.shunt.noise_per_A = 0.0;
  }
  return p;
}

class PowerStageDevice final : public RackDevice {
 public:
  PowerStageDevice(DeviceSlot& slot, const PowerStageParams& params)
      : motor_(slot.whole("motor")),
        happened_(slot.rack().happened()),
        stage_(params, slot.rack().seed(), slot.name()) {
    join(slot);
    report_faults(slot.name(), slot.rack().finding());
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::shaft_load, motor_}}; }
  void on_message(const io::Reader& message) override {
    stage_.set_load(message.as<io::ShaftLoad>(), message.header().t_ns);
  }
  void report(Nanoseconds now) override {
    happened_.add(io::Kind::shaft_state, motor_, now, stage_.report(now));
  }

 private:
  void join(DeviceSlot& slot) {
    for (int leg = 0; leg < 3; ++leg) {
      io::Wire& upper = slot.wire(PowerStage::kUpper_pins[leg]);
      io::Wire& lower = slot.wire(PowerStage::kLower_pins[leg]);
      slot.set_analog(PowerStage::kPhase_pins[leg],
                      [this, leg](Nanoseconds now) { return stage_.phase_V(leg, now); });
      stage_.wire(leg, true, upper);
      stage_.wire(leg, false, lower);
    }
    slot.set_analog(PowerStage::kBus_pin, [this](Nanoseconds now) { return stage_.bus_V(now); });
    slot.set_analog(PowerStage::kShunt_pin,
                    [this](Nanoseconds now) { return stage_.shunt_V(now); });
  }
  void report_faults(const std::string& name, const io::FindingSink& finding) {
    stage_.on_shoot_through(
        [this, name, finding](int leg, Nanoseconds start_ns, Nanoseconds end_ns) {
          happened_.add(io::Kind::shoot_through, static_cast<std::uint16_t>(leg), end_ns,
                        io::ShootThrough{start_ns});
          finding({end_ns, name,
                   "shoot-through: both switches of leg " + std::string(1, "abc"[leg]) +
                       " were on for " + std::to_string(end_ns - start_ns) + " ns"});
        });
    stage_.on_backwards([name, finding](Nanoseconds now) {
      finding({now, name,
               "the motor turns backwards, without any load of the air: swap two of its wires "
               "(swap_wires) or the firmware's direction"});
    });
  }

  std::uint16_t motor_;
  io::Batch& happened_;
  PowerStage stage_;
};

std::unique_ptr<RackDevice> make_stage(DeviceSlot& slot) {
  const PowerStageParams params = stage_params(slot);
  if (slot.failed(plant::validate(params.motor, slot.place()))) return nullptr;
  return std::make_unique<PowerStageDevice>(slot, params);
}

std::vector<std::string> all_pins() {
  std::vector<std::string> pins = {PowerStage::kBus_pin, PowerStage::kShunt_pin};
  for (const auto& three :
       {PowerStage::kUpper_pins, PowerStage::kLower_pins, PowerStage::kPhase_pins}) {
    for (int leg = 0; leg < 3; ++leg) pins.emplace_back(three[leg]);
  }
  return pins;
}

DeviceKey amperes(const char* name, const char* about) {
  return quantity_key(std::string("params.") + name, Dimension::current, "A", {0.0, 100.0}, about);
}

std::vector<DeviceKey> motor_keys() {
  const plant::MotorParams usual;
  return {
      {.path = "bus", .about = "no bus: pins of its own", .kind = KeyKind::word, .unit = "pins"},
      motor_key().need(),
      quantity_key("params.torque_constant", Dimension::none, "N m/A", {1e-5, 1.0},
                   "60/(2 pi Kv), a bare number")
          .with(usual.torque_constant_NmpA),
      quantity_key("params.resistance", Dimension::resistance, "mohm", {1e-4, 100.0},
                   "line to line, of winding, bridge and leads")
          .with(usual.resistance_ohm),
      quantity_key("params.inductance", Dimension::inductance, "uH", {1e-7, 1.0}, "line to line")
          .with(usual.inductance_H),
      amperes("no_load_current", "iron and friction").with(usual.no_load_current_A),
      quantity_key("params.inertia", Dimension::inertia, "kg m2", {1e-9, 1.0},
                   "rotor, bell and propeller")
          .with(usual.inertia_kgm2),
      quantity_key("params.bus_capacitance", Dimension::none, "F", {10e-6, 0.1},
                   "before the bridge, a bare number")
          .with(PowerStageParams{}.bus_capacitance_F),
      quantity_key("params.bus_esr", Dimension::resistance, "mohm", {0.0, 1.0}, "in series with it")
          .with(PowerStageParams{}.bus_esr_ohm),
      flag_key("params.swap_wires", "two of the motor's wires: it turns the other way").with(false),
  };
}

DeviceKey bare(const std::string& name, const char* unit, Limits limits, const char* about) {
  return quantity_key("params." + name, Dimension::none, unit, limits, about);
}

void add_copy_keys(std::vector<DeviceKey>& keys) {
  const plant::MotorParams usual;
  keys.push_back(quantity_key("params.winding_resistance", Dimension::resistance, "mohm",
                              {0.0, 100.0}, "the share of `resistance` that warms")
                     .with(usual.winding_resistance_ohm));
  keys.push_back(
      quantity_key("params.diode_drop", Dimension::voltage, "V", {0.0, 3.0}, "of the bridge")
          .with(usual.diode_drop_V));
  keys.push_back(bare("heat_capacity", "J/K", {0.0, 1e6}, "of winding and iron; 0: never warms")
                     .with(usual.heat_capacity_JpK));
  keys.push_back(bare("heat_resistance", "K/W", {1e-6, 1e6}, "to the air, a bare number")
                     .with(usual.heat_resistance_KpW));
  keys.push_back(bare("ambient", "K", {200.0, 400.0}, "the air that cools, a bare number")
                     .with(usual.ambient_temp_K));
  keys.push_back(bare("start_temperature", "K", {200.0, 500.0}, "of the winding at power-up")
                     .with_text("the ambient"));
  keys.push_back(
      bare("bearing_share", "", {0.0, 1.0}, "of the no-load torque that warmth takes off")
          .with(usual.bearing_share));
  keys.push_back(bare("sine_share", "", {0.0, 1.0}, "of the back-EMF's shape; the rest: trapezoid")
                     .with(usual.phases.sine_share));
  keys.push_back(quantity_key("params.cogging", Dimension::torque, "mN m", {0.0, 1.0}, "amplitude")
                     .with(usual.phases.cogging_Nm));
  for (std::size_t k = 0; k < 3; ++k) {
    for (const auto& [name, about] :
         {std::pair{"impedance.", "of this phase's R and L, off the others' mean"},
          std::pair{"emf.", "of this phase's back-EMF, off the motor's"}}) {
      keys.push_back(quantity_key(std::string("params.") + name + kPin_names[k], Dimension::ratio,
                                  "%", {-0.5, 0.5}, about)
                         .with(0.0));
    }
  }
}

void add_pin_keys(std::vector<DeviceKey>& keys) {
  for (std::size_t pin = 0; pin < PowerStageParams::kPins; ++pin) {
    keys.push_back(quantity_key(of_pin("gain", pin), Dimension::ratio, "%", {-0.1, 0.1},
                                "of converter and reference")
                       .with(0.0));
    keys.push_back(
        quantity_key(of_pin("offset", pin), Dimension::voltage, "mV", {-0.1, 0.1}, "at the pin")
            .with(0.0));
    keys.push_back(quantity_key(of_pin("noise", pin), Dimension::voltage, "mV", {0.0, 0.1},
                                "at the pin, standard deviation")
                       .with(0.0));
    if (pin == PowerStageParams::kShunt) continue;
    keys.push_back(quantity_key(std::string("params.divider.") + kPin_names[pin], Dimension::ratio,
                                "%", {-0.1, 0.1}, "of its divider's ratio")
                       .with(0.0));
  }
}

void add_shunt_keys(std::vector<DeviceKey>& keys) {
  const plant::CurrentShuntParams usual;
  keys.push_back(amperes("shunt.offset", "where the current sense settles at no current")
                     .with_text("drawn, 4.1..4.6 A"));
  keys.push_back(quantity_key("params.shunt.gain", Dimension::ratio, "%", {0.0, 0.5},
                              "its tolerance, drawn from")
                     .with(usual.gain_tolerance));
  keys.push_back(quantity_key("params.shunt.gain_error", Dimension::ratio, "%", {-0.5, 0.5},
                              "this part's own, instead")
                     .with_text("drawn")
                     .instead_of("params.shunt.gain"));
  keys.push_back(quantity_key("params.shunt.pole", Dimension::frequency, "Hz", {100.0, 1e5},
                              "of its amplifier")
                     .with(usual.pole_Hz));
  keys.push_back(amperes("shunt.noise", "the same at any current").with_text("grows with current"));
  keys.push_back(amperes("shunt.warm_up", "offset's excess at power-up, standard deviation")
                     .with(usual.warm_up_A));
  keys.push_back(amperes("shunt.wander", "of the offset, standard deviation").with(usual.wander_A));
}

}  // namespace

DeviceType power_stage_type() {
  std::vector<DeviceKey> keys = motor_keys();
  add_copy_keys(keys);
  add_pin_keys(keys);
  add_shunt_keys(keys);
  return {"power_stage", "switches, motor and current sense, wired as on the ESC32v2",
          std::move(keys), make_stage, all_pins()};
}

}  // namespace whirl::rack

// Six switches, a motor and what the chip measures of it (models/power_stage.hpp), with the findings
// that it has to report.
#include "io_bridges/rack/models/power_stage.hpp"

#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

PowerStageParams params_of(const DeviceSlot& slot) {
  PowerStageParams p;
  p.motor.torque_constant_NmpA = slot.quantity("params.torque_constant");
  p.motor.resistance_ohm = slot.quantity("params.resistance");
  p.motor.inductance_H = slot.quantity("params.inductance");
  p.motor.no_load_current_A = slot.quantity("params.no_load_current");
  p.motor.inertia_kgm2 = slot.quantity("params.inertia");
  p.bus_capacitance_F = slot.quantity("params.bus_capacitance");
  p.swap_wires = slot.flag("params.swap_wires");
  p.shunt.gain_tolerance = slot.quantity("params.shunt.gain");
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

std::unique_ptr<RackDevice> make(DeviceSlot& slot) {
  const PowerStageParams params = params_of(slot);
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
      flag_key("params.swap_wires", "two of the motor's wires: it turns the other way").with(false),
  };
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
  keys.push_back(amperes("shunt.noise", "the same at any current").with_text("grows with current"));
  keys.push_back(amperes("shunt.warm_up", "offset's excess at power-up, standard deviation")
                     .with(usual.warm_up_A));
  keys.push_back(amperes("shunt.wander", "of the offset, standard deviation").with(usual.wander_A));
}

}  // namespace

DeviceType power_stage_type() {
  std::vector<DeviceKey> keys = motor_keys();
  add_shunt_keys(keys);
  return {"power_stage", "switches, motor and current sense, wired as on the ESC32v2",
          std::move(keys), make, all_pins()};
}

}  // namespace whirl::rack

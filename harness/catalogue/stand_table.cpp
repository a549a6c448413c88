#include "harness/catalogue/stand_table.hpp"

#include "harness/catalogue/esc_mode.hpp"
#include "harness/catalogue/feed.hpp"
#include "harness/catalogue/motor.hpp"
#include "harness/catalogue/place_air.hpp"
#include "harness/catalogue/propeller_file.hpp"
#include "harness/catalogue/shunt.hpp"
#include "harness/catalogue/tolerance_key.hpp"
#include "plant/parts/esc_stand.hpp"

namespace whirl::catalogue {
namespace {

// Only what the plan has written goes to the board: the rest is the board's own.
auto passing(const lua::Table& t, stand::StageParams& stage, bool all = false) {
  return [&t, &stage, all](const char* key, const char* name, double value) {
    if (all || t.has(key)) stage[name] = value;
  };
}

void read_stage_motor(const lua::Table& t, stand::StageParams& stage) {
  const plant::MotorParams m = read_motor(t, MissingKeys::as_in_plant);
  if (t.has("file") && m.pole_pairs != plant::MotorParams{}.pole_pairs) {
    t.refuse("file", "its pole pairs cannot differ on a stand",
             "only a vehicle's motor has its own");
  }
  const auto pass = passing(t, stage, t.has("file"));
  pass("kv_rpm_per_V", "torque_constant", m.torque_constant_NmpA);
  pass("resistance", "resistance", m.resistance_ohm);
  pass("resistance_fitted_at", "resistance", m.resistance_ohm);
  pass("inductance", "inductance", m.inductance_H);
  pass("no_load_current", "no_load_current", m.no_load_current_A);
  pass("inertia", "inertia", m.inertia_kgm2);
  const auto own = [&](const char* key, Dimension dimension, lua::Range range) {
    if (t.has(key)) stage[key] = t.quantity(key, dimension, range);
  };
  own("diode_drop", Dimension::voltage, lua::between(0.0, 3.0));
  own("start_temperature", Dimension::temperature, lua::between(200.0, 500.0));
  if (t.flag_or("swap_wires", false)) stage["swap_wires"] = 1.0;
  for (const char* key : {"winding_resistance", "pole_pairs"}) {
    if (t.has(key)) t.refuse(key, "cannot differ on a stand", "only a vehicle's motor has its own");
  }
}

void read_stage_shunt(const lua::Table& t, stand::StageParams& stage) {
  const plant::CurrentShuntParams s = read_shunt(t);
  const auto pass = passing(t, stage);
  pass("gain", "shunt.gain_error", s.gain_error);
  pass("gain_tolerance", "shunt.gain", s.gain_tolerance);
  pass("offset", "shunt.offset", s.offset_low_A);
  pass("noise", "shunt.noise", s.noise_A);
  pass("warm_up", "shunt.warm_up", s.warm_up_A);
  pass("wander", "shunt.wander", s.wander_A);
}

void check_warmth(const lua::Table& t, const stand::StandParams& p) {
  if (!p.stage.contains("start_temperature")) return;
  const auto heat = p.tolerance.find("heat");
  if (heat != p.tolerance.end() && heat->second != plant::ToleranceClass::none) return;
  t.refuse("motor", "start_temperature: the drawing's motor neither warms nor cools",
           "tolerance = { heat = \"typical\" }");
}

// The motor is cooled by the same air.
void read_air(const lua::Table& t, stand::StandParams& p) {
  p.air = read_place_air(t).at_ground();
  p.stage["ambient"] = p.air->temperature_K;
}

std::string read_throttle(const lua::Table& t) {
  return t.has("throttle") ? t.choice("throttle", {"i2c", "pwm", "can", "can_rpm"}) : "i2c";
}

void read_can(const lua::Table& t, stand::EscMasterParams& esc) {
  const std::string throttle = read_throttle(t);
  if (!throttle.starts_with("can")) return;
  esc.can = static_cast<std::uint16_t>(t.integer_or("can", 1, 1, 2));
  esc.rpm_command = throttle == "can_rpm";
  if (esc.rpm_command && esc.mode != io::EscMode::rpm) {
    t.refuse("throttle", "can_rpm asks for speeds, and the stand's mode takes none",
             "mode = \"rpm\"");
  }
}

double read_pulse_rate(const lua::Table& t) {
  if (read_throttle(t) != "pwm") return 0.0;
  return t.quantity_or("pulse_rate", Dimension::frequency, 50.0, lua::between(50.0, 400.0));
}

}  // namespace

Result<stand::StandParams> read_stand(const lua::Table& t, const std::string& propellers) {
  stand::StandParams p;
  const std::string prop = t.text("prop");
  p.battery = read_feed(t);
  if (t.has("air")) read_air(t.table("air"), p);
  if (t.has("motor")) read_stage_motor(t.table("motor"), p.stage);
  if (t.has("shunt")) read_stage_shunt(t.table("shunt"), p.stage);
  p.tolerance = read_tolerance(t, plant::esc_stand_groups(), plant::ToleranceClass::typical);
  check_warmth(t, p);
  if (t.has("mode")) p.esc.mode = read_esc_mode(t, "mode").on_wire;
  p.esc.address = static_cast<std::uint8_t>(t.integer_or("address", p.esc.address, 0x08, 0x77));
  p.esc.pulse_rate_Hz = read_pulse_rate(t);
  read_can(t, p.esc);
  p.esc.i2c = static_cast<std::uint16_t>(t.integer_or("i2c", p.esc.i2c, 1, 3));
  p.esc.serial = static_cast<std::uint16_t>(t.integer_or("serial", p.esc.serial, 1, 8));
  if (const auto good = t.finish(); !good) return good.error();
  const auto turned = read_propeller_file(propellers + "/" + prop + ".lua");
  if (!turned) return turned.error();
  p.blade = turned.value().blade;
  p.doubts = turned.value().doubts();
  return p;
}

}  // namespace whirl::catalogue

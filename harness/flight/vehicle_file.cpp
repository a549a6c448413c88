#include "harness/flight/vehicle_file.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "base/rpm.hpp"
#include "firmware/esc/core/parameters.hpp"
#include "harness/flight/propeller_file.hpp"
#include "harness/lua/table.hpp"

namespace whirl::flight {
namespace {

using lua::above;
using lua::at_least;
using lua::between;
using lua::Table;

void read_airframe(const Table& t, plant::AirframeParams& a) {
  a.mass_kg = t.quantity("mass", Dimension::mass, above(0.0));
  const auto inertia = t.quantities("inertia", Dimension::inertia, above(0.0));
  if (inertia.size() != 3) {
    t.refuse("inertia", "needs three values, about x, y and z");
  } else {
    a.inertia_kgm2 = {inertia[0], inertia[1], inertia[2]};
  }
  const double arm = t.quantity("arm", Dimension::length, above(0.0));
  const double above_m = t.quantity_or("rotor_height", Dimension::length, 0.03);
  // Motor 1 front, 2 right, 3 rear, 4 left; 1 and 3 counter-clockwise seen from above.
  const Eigen::Vector3d at[] = {
      {arm, 0, -above_m}, {0, arm, -above_m}, {-arm, 0, -above_m}, {0, -arm, -above_m}};
  for (std::size_t i = 0; i < 4; ++i) {
    a.rotors[i].p_BP_B_m = at[i];
    a.rotors[i].spin = i % 2 == 0 ? +1 : -1;
  }
  a.parasitic_area_m2 = t.number_or("parasitic_area_m2", 0.0, at_least(0.0));
  a.rotor_drag_spm = t.number_or("rotor_drag_s_per_m", 0.0, at_least(0.0));
}

void read_gear(const Table& t, plant::ContactParams& c) {
  const double half = t.quantity("half_span", Dimension::length, above(0.0));
  const double below = t.quantity("below", Dimension::length, above(0.0));
  c.gear_B_m.clear();
  for (const double x : {-half, half}) {
    for (const double y : {-half, half}) c.gear_B_m.emplace_back(x, y, below);
  }
  c.foot_radius_m = t.quantity_or("foot_radius", Dimension::length, c.foot_radius_m, above(0.0));
  c.restitution = t.number_or("restitution", c.restitution, between(0.0, 1.0));
  c.friction = t.number_or("friction", c.friction, at_least(0.0));
}

void read_motor(const Table& t, plant::MotorParams& m) {
  const double kv = t.number("kv_rpm_per_V", above(0.0));
  if (kv > 0.0) m.torque_constant_NmpA = torque_constant_NmpA_of(kv);
  m.resistance_ohm = t.quantity("resistance", Dimension::resistance, above(0.0));
  m.winding_resistance_ohm = t.quantity_or("winding_resistance", Dimension::resistance,
                                           m.winding_resistance_ohm, above(0.0));
  // Data sheets keep quiet about it: 0.2 ms x resistance is usual among outrunners.
  m.inductance_H =
      t.quantity_or("inductance", Dimension::inductance, 2e-4 * m.resistance_ohm, above(0.0));
  m.no_load_current_A = t.quantity("no_load_current", Dimension::current, at_least(0.0));
  m.inertia_kgm2 = t.quantity("inertia", Dimension::inertia, above(0.0));
  m.pole_pairs = static_cast<int>(t.integer_or("pole_pairs", m.pole_pairs, 1, 100));
  // A resistance read from a running motor holds what commutation looks like at that speed.
  const double fitted_radps =
      t.quantity_or("resistance_fitted_at", Dimension::angular_rate, 0.0, at_least(0.0));
  const double commutation_ohm =
      1.5 / std::numbers::pi * m.pole_pairs * fitted_radps * m.inductance_H;
  if (fitted_radps > 0.0 && commutation_ohm >= m.resistance_ohm) {
    return t.refuse("resistance_fitted_at",
                    "at this speed commutation alone looks like more than the whole resistance");
  }
  m.resistance_ohm -= commutation_ohm;
  m.winding_resistance_ohm = std::min(m.winding_resistance_ohm, m.resistance_ohm);
}

void read_battery(const Table& t, plant::BatteryParams& b) {
  if (t.choice("kind", {"lipo_4s_2200", "lab_supply"}) == "lab_supply") {
    b = plant::lab_supply(t.quantity("voltage", Dimension::voltage, above(0.0)),
                          t.quantity("resistance", Dimension::resistance, at_least(0.0)));
    return;
  }
  b = plant::lipo_4s_2200();
  b.capacity_C = t.quantity_or("capacity", Dimension::charge, b.capacity_C, above(0.0));
  b.series_resistance_ohm =
      t.quantity_or("resistance", Dimension::resistance, b.series_resistance_ohm, at_least(0.0));
  b.initial_depth_of_discharge = t.quantity_or("depth_of_discharge", Dimension::ratio,
                                               b.initial_depth_of_discharge, between(0.0, 1.0));
}

// "set kt 0.01005": what a stand has found, as it types it into the image. False: not such a line.
bool take_set_line(const std::string& line, fw::esc::Calibration& c) {
  std::istringstream words(line);
  std::string verb, name, rest;
  double value = 0.0;
  if (!(words >> verb >> name >> value) || verb != "set" || words >> rest) return false;
  for (const fw::esc::Parameter& parameter : fw::esc::kParameters) {
    if (parameter.name != name) continue;
    parameter.in(c) = static_cast<float>(value);
    return std::isfinite(parameter.in(c));
  }
  return false;
}

void read_calibration_file(const Table& t, fw::esc::Calibration& c) {
  const auto file = lua::read_file(t.sibling(t.text("file")));
  if (!file) return t.refuse("file", file.error().message());
  std::ignore = file.value().choice("kind", {"esc_calibration"});
  for (const std::string& line : file.value().texts("set")) {
    if (!take_set_line(line, c)) return t.refuse("file", "'" + line + "' sets nothing of an ESC");
  }
  if (const auto good = file.value().finish(); !good) t.refuse("file", good.error().message());
  c.identified = true;
}

// The numbers of a stand's file, then those given here by the names of the image's `set`, SI without
// units.
void read_calibration(const Table& t, fw::esc::Calibration& c) {
  if (t.has("file")) read_calibration_file(t, c);
  for (const fw::esc::Parameter& parameter : fw::esc::kParameters) {
    float& value = parameter.in(c);
    value = static_cast<float>(t.number_or(parameter.name, static_cast<double>(value)));
  }
  c.identified = t.flag_or("identified", c.identified);
}

void read_shunt(const Table& t, plant::CurrentShuntParams& s) {
  const double offset_A = t.quantity_or("offset", Dimension::current, -1.0, at_least(0.0));
  if (offset_A >= 0.0) s.offset_low_A = s.offset_high_A = offset_A;
  s.gain_tolerance =
      t.quantity_or("gain_tolerance", Dimension::ratio, s.gain_tolerance, between(0.0, 0.5));
  s.warm_up_A = t.quantity_or("warm_up", Dimension::current, s.warm_up_A, at_least(0.0));
  s.wander_A = t.quantity_or("wander", Dimension::current, s.wander_A, at_least(0.0));
  s.noise_A = t.quantity_or("noise", Dimension::current, s.noise_A, at_least(0.0));
}

void read_esc(const Table& t, EscParams& e) {
  using fw::esc::Mode;
  const std::map<std::string, Mode> modes = {{"duty", Mode::duty},
                                             {"rpm", Mode::speed},
                                             {"thrust_by_rpm", Mode::thrust_by_speed},
                                             {"power", Mode::power},
                                             {"thrust_by_power", Mode::thrust_by_power}};
  fw::esc::Calibration& c = e.calibration;
  if (t.has("calibration")) read_calibration(t.table("calibration"), c);
  if (t.has("shunt")) read_shunt(t.table("shunt"), e.shunt);
  const auto mode =
      modes.find(t.choice("mode", {"duty", "rpm", "thrust_by_rpm", "power", "thrust_by_power"}));
  if (mode != modes.end()) c.mode = mode->second;
  const auto into = [&t](const char* key, Dimension dimension, float& value, lua::Range range) {
    value = static_cast<float>(t.quantity_or(key, dimension, static_cast<double>(value), range));
  };
  into("max_current", Dimension::current, c.motor.max_current_A, above(0.0));
  into("brake_current", Dimension::current, c.motor.max_braking_A, at_least(0.0));
  into("arming_voltage", Dimension::voltage, c.arming_voltage_V, at_least(0.0));
}

void read_capture(const Table& t, CaptureParams& c) {
  c.rate_Hz = t.quantity_or("rate", Dimension::frequency, c.rate_Hz, between(0.1, 1000.0));
  c.latency_ns = t.duration_ns_or("latency", c.latency_ns);
  plant::MotionCaptureParams& cameras = c.cameras;
  cameras.period_s =
      1.0 / t.quantity_or("camera_rate", Dimension::frequency, 200.0, between(1.0, 1000.0));
  cameras.position_noise_m =
      t.quantity_or("position_noise", Dimension::length, cameras.position_noise_m, at_least(0.0));
  cameras.attitude_noise_rad =
      t.quantity_or("angle_noise", Dimension::angle, cameras.attitude_noise_rad, at_least(0.0));
}

}  // namespace

Result<FlightParams> read_vehicle(const std::string& path) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  const Table& t = file.value();
  FlightParams p;
  std::ignore = t.choice("kind", {"vehicle"});
  p.name = t.text("name");
  read_airframe(t, p.vehicle.airframe);
  read_gear(t.table("gear"), p.vehicle.airframe.contact);
  p.vehicle.avionics_current_A = t.quantity_or("avionics_current", Dimension::current,
                                               p.vehicle.avionics_current_A, at_least(0.0));
  read_motor(t.table("motor"), p.vehicle.motor);
  read_battery(t.table("battery"), p.vehicle.battery);
  read_esc(t.table("esc"), p.esc);
  p.esc.pole_pairs = p.vehicle.motor.pole_pairs;
  if (t.has("capture")) read_capture(t.table("capture"), p.capture);
  const std::string propeller = t.text("propeller");
  if (const auto good = t.finish(); !good) return good.error();

  auto blade = read_propeller(t.sibling(propeller));
  if (!blade) return blade.error();
  p.blade = blade.value();
  for (plant::RotorMount& mount : p.vehicle.airframe.rotors) {
    mount.radius_m = plant::radius_m(*p.blade);
  }
  if (const auto good = plant::validate(p.vehicle, path); !good) return good.error();
  return p;
}

}  // namespace whirl::flight

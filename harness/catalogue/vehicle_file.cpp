#include "harness/catalogue/vehicle_file.hpp"

#include "harness/catalogue/esc_setup.hpp"
#include "harness/catalogue/feed.hpp"
#include "harness/catalogue/motor.hpp"
#include "harness/catalogue/propeller_file.hpp"
#include "harness/catalogue/tolerance_key.hpp"
#include "harness/flight/controllers.hpp"
#include "harness/lua/table.hpp"
#include "plant/parts/vehicle.hpp"

namespace whirl::catalogue {
namespace {

using lua::above;
using lua::at_least;
using lua::between;
using lua::Table;

int spin_of(const Table& t) {
  return t.choice("spin", {"ccw", "cw"}) == "cw" ? -1 : +1;
}

// Motor 1 front, 2 right, 3 rear, 4 left; 1 and 3 counter-clockwise seen from above.
std::vector<plant::RotorMount> plus_quad(double arm_m, double above_m) {
  return {{{arm_m, 0, -above_m}, +1},
          {{0, arm_m, -above_m}, -1},
          {{-arm_m, 0, -above_m}, +1},
          {{0, -arm_m, -above_m}, -1}};
}

// Of the last one with those before it.
void refuse_shared_place(const Table& motor, const std::vector<plant::RotorMount>& rotors) {
  constexpr double kApart_m = 0.01;  // two discs one above the other are further apart
  for (std::size_t i = 0; i + 1 < rotors.size(); ++i) {
    if ((rotors[i].p_BP_B_m - rotors.back().p_BP_B_m).norm() >= kApart_m) continue;
    motor.refuse("place", "is that of motor " + std::to_string(i + 1) + ", within 1 cm");
  }
}

void read_rotors(const Table& t, plant::AirframeParams& a) {
  const double above_m = t.quantity_or("rotor_height", Dimension::length, 0.03);
  if (t.has("arm") == t.has("motors")) {
    return t.refuse("arm", "either the arm of a quad, or a list of motors, is wanted",
                    "arm = \"25 cm\", or motors = { { place = { forward = \"25 cm\", right = "
                    "\"0 cm\" }, spin = \"ccw\" }, ... }");
  }
  if (t.has("arm")) {
    a.rotors = plus_quad(t.quantity("arm", Dimension::length, above(0.0)), above_m);
    return;
  }
  for (const Table& motor : t.tables("motors")) {
    const Table place = motor.table("place");
    a.rotors.push_back(
        {{place.quantity("forward", Dimension::length), place.quantity("right", Dimension::length),
          -place.quantity_or("above", Dimension::length, above_m)},
         spin_of(motor)});
    refuse_shared_place(motor, a.rotors);
  }
  if (a.rotors.empty() || a.rotors.size() > plant::kMostMotors) {
    t.refuse("motors", "1 to " + std::to_string(plant::kMostMotors) + " motors are wanted, not " +
                           std::to_string(a.rotors.size()));
  }
}

// Areas seen along x, y and z, each with the coefficient or with its own.
void read_drag(const Table& t, plant::AirframeParams& a) {
  const auto areas_m2 = t.numbers("frontal_areas_m2", between(0.0, 10.0));
  const auto coefficients = t.numbers("drag_coefficients", between(0.0, 3.0));
  if (areas_m2.size() != 3) return t.refuse("frontal_areas_m2", "needs three, along x, y and z");
  if (coefficients.size() != 3) {
    return t.refuse("drag_coefficients", "needs three, along x, y and z");
  }
  for (std::size_t i = 0; i < 3; ++i) {
    a.drag_area_m2[static_cast<Eigen::Index>(i)] = areas_m2[i] * coefficients[i];
  }
}

// One figure for each motor.
void read_unbalance(const Table& t, plant::AirframeParams& a) {
  constexpr double kKgm_per_g_mm = 1e-6;
  const auto each = t.numbers("unbalance_g_mm", between(0.0, 1e4));
  if (each.size() != a.rotors.size()) {
    return t.refuse("unbalance_g_mm",
                    "needs " + std::to_string(a.rotors.size()) + " values, one for each motor");
  }
  for (std::size_t i = 0; i < each.size(); ++i) a.rotors[i].unbalance_kgm = each[i] * kKgm_per_g_mm;
}

void read_airframe(const Table& t, plant::AirframeParams& a) {
  a.mass_kg = t.quantity("mass", Dimension::mass, above(0.0));
  const auto inertia = t.quantities("inertia", Dimension::inertia, above(0.0));
  if (inertia.size() != 3) {
    t.refuse("inertia", "needs three values, about x, y and z");
  } else {
    a.inertia_kgm2 = {inertia[0], inertia[1], inertia[2]};
  }
  read_rotors(t, a);
  if (t.has("unbalance_g_mm")) read_unbalance(t, a);
  if (t.has("frontal_areas_m2") || t.has("drag_coefficients")) read_drag(t, a);
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

std::string controller_of(const Table& esc) {
  const auto names = flight::names_of(flight::controller_types());
  return esc.has("controller") ? esc.choice("controller", names) : names.front();
}

void read_capture(const Table& t, flight::CaptureParams& c) {
  c.rate_Hz = t.quantity_or("rate", Dimension::frequency, c.rate_Hz, between(0.1, 1000.0));
  c.latency_ns = t.duration_ns_or("latency", c.latency_ns);
  plant::MotionCaptureParams& cameras = c.cameras;
  cameras.period_s =
      1.0 / t.quantity_or("camera_rate", Dimension::frequency, 200.0, between(1.0, 1000.0));
  cameras.position_noise_m =
      t.quantity_or("position_noise", Dimension::length, cameras.position_noise_m, at_least(0.0));
  cameras.attitude_noise_rad =
      t.quantity_or("angle_noise", Dimension::angle, cameras.attitude_noise_rad, at_least(0.0));
  cameras.occlusion_chance = t.quantity_or("occlusion_chance", Dimension::ratio,
                                           cameras.occlusion_chance, between(0.0, 0.99));
}

}  // namespace

Result<flight::FlightParams> read_vehicle(const std::string& path, const Settings& settings) {
  auto file = lua::read_file(path);
  if (!file) return file.error();
  for (const Setting& setting : settings) {
    const std::string_view key = path_in(setting, "vehicle");
    if (key.empty()) continue;
    if (const auto set = file.value().put(key, setting.value); !set) return set.error();
  }
  const Table& t = file.value();
  flight::FlightParams p;
  std::ignore = t.choice("kind", {"vehicle"});
  p.name = t.text("name");
  read_airframe(t, p.vehicle.airframe);
  read_gear(t.table("gear"), p.vehicle.airframe.contact);
  p.vehicle.avionics_current_A = t.quantity_or("avionics_current", Dimension::current,
                                               p.vehicle.avionics_current_A, at_least(0.0));
  p.vehicle.motor = read_motor(t.table("motor"), MissingKeys::refused);
  p.vehicle.battery = read_feed(t);
  p.tolerance = read_tolerance(t, plant::vehicle_groups(), plant::ToleranceClass::none);
  const Table esc = t.table("esc");
  p.controller = controller_of(esc);
  p.esc = read_esc(esc);
  p.esc.pole_pairs = p.vehicle.motor.pole_pairs;
  p.still_air = read_still_air(esc, p.esc.calibration);
  if (t.has("capture")) read_capture(t.table("capture"), p.capture);
  const std::string propeller = t.text("propeller");
  if (const auto good = t.finish(); !good) return good.error();

  const auto turned = read_propeller_file(t.sibling(propeller));
  if (!turned) return turned.error();
  p.blade = turned.value().blade;
  p.fit = turned.value().fit;
  p.doubts = turned.value().doubts();
  for (plant::RotorMount& mount : p.vehicle.airframe.rotors) {
    mount.radius_m = plant::radius_m(*p.blade);
  }
  if (const auto good = plant::validate(p.vehicle, path); !good) return good.error();
  return p;
}

}  // namespace whirl::catalogue

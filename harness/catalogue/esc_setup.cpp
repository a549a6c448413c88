#include "harness/catalogue/esc_setup.hpp"

#include <cmath>
#include <sstream>

#include "firmware/esc/core/parameters.hpp"
#include "harness/catalogue/esc_mode.hpp"
#include "harness/catalogue/shunt.hpp"

namespace whirl::catalogue {
namespace {

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

void read_calibration_file(const lua::Table& t, fw::esc::Calibration& c) {
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
void read_constants(const lua::Table& t, fw::esc::Calibration& c) {
  if (t.has("file")) read_calibration_file(t, c);
  for (const fw::esc::Parameter& parameter : fw::esc::kParameters) {
    float& value = parameter.in(c);
    constexpr double kMost = 1e12;  // the image counts in single precision
    value = static_cast<float>(
        t.number_or(parameter.name, static_cast<double>(value), lua::between(-kMost, kMost)));
  }
  for (const char* name : {"kt", "resistance", "inductance", "inertia"}) {
    if (t.has(name) && !(t.number(name) > 0.0)) t.refuse(name, "must be above 0");
  }
  c.identified = t.flag_or("identified", c.identified);
}

}  // namespace

flight::EscParams read_esc(const lua::Table& t) {
  flight::EscParams e;
  fw::esc::Calibration& c = e.calibration;
  if (t.has("calibration")) read_constants(t.table("calibration"), c);
  if (t.has("shunt")) e.shunt = read_shunt(t.table("shunt"));
  c.mode = read_esc_mode(t, "mode").in_core;
  const auto read = [&t](const char* key, Dimension dimension, float& value, lua::Range range) {
    value = static_cast<float>(t.quantity_or(key, dimension, static_cast<double>(value), range));
  };
  read("max_current", Dimension::current, c.motor.max_current_A,
       {.low = 0.0, .high = 1000.0, .low_open = true});
  read("brake_current", Dimension::current, c.motor.max_braking_A, lua::between(0.0, 1000.0));
  read("arming_voltage", Dimension::voltage, c.arming_voltage_V, lua::between(0.0, 1000.0));
  return e;
}

std::optional<flight::StillAirRun> read_still_air(const lua::Table& t,
                                                  const fw::esc::Calibration& calibration) {
  if (!t.has("still_air")) return {};
  if (!calibration.identified) t.refuse("still_air", "wants an ESC with a calibration");
  const lua::Table asked = t.table("still_air");
  const io::EscRange range = io::range_of(io::EscMode::thrust_by_rpm);
  flight::StillAirRun run;
  run.thrust_N = asked.quantity("thrust", Dimension::force, lua::between(range.min, range.max));
  run.warm_up_ns = asked.duration_ns_or("warm_up", run.warm_up_ns);
  constexpr std::int64_t kLeast_ns = 2'000'000'000, kMost_ns = 600'000'000'000;
  if (run.warm_up_ns < kLeast_ns || run.warm_up_ns > kMost_ns) {
    asked.refuse("warm_up", "must be within 2 s .. 600 s");
  }
  return run;
}

}  // namespace whirl::catalogue

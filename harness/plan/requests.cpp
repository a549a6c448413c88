#include "harness/plan/requests.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "harness/plan/contradictions.hpp"
#include "harness/plan/waypoint_file.hpp"

namespace whirl::plan {
namespace {

std::string typed_line(const lua::Table& t) {
  std::string line = t.text("line");
  if (!is_one_line(line)) t.refuse("line", "is not one line of ASCII text");
  return line;
}

using lua::above;
using lua::at_least;
using lua::between;
using lua::Table;
using namespace request;

std::optional<double> maybe(const Table& t, const char* key, Dimension dimension,
                            lua::Range range = lua::kAny) {
  if (!t.has(key)) return std::nullopt;
  return t.quantity(key, dimension, range);
}

GoTo read_go_to(const Table& t) {
  GoTo go;
  go.yaw_rad = maybe(t, "yaw", Dimension::angle);
  go.speed_mps = maybe(t, "speed", Dimension::speed, above(0.0));
  if (!t.has("position")) return go;
  const Table p = t.table("position");
  go.north_m = maybe(p, "north", Dimension::length);
  go.east_m = maybe(p, "east", Dimension::length);
  go.height_m = maybe(p, "height", Dimension::length);
  return go;
}

// {} is the thesis's: 1 m, 1 m, 1.1 m, 20 s.
Figure8 read_figure_8(const Table& t) {
  Figure8 figure;
  figure.north_m = t.quantity_or("north", Dimension::length, figure.north_m);
  figure.east_m = t.quantity_or("east", Dimension::length, figure.east_m);
  figure.height_m = t.quantity_or("height", Dimension::length, figure.height_m, above(0.0));
  figure.period_s = t.quantity_or("period", Dimension::time, figure.period_s, at_least(1.0));
  return figure;
}

Cruise read_cruise(const Table& t) {
  return {t.quantity_or("north", Dimension::speed, 0.0),
          t.quantity_or("east", Dimension::speed, 0.0),
          maybe(t, "height", Dimension::length, above(0.0))};
}

// { attitude = { roll = "20 deg", pitch = "0 deg", yaw_rate = "10 deg/s" }, thrust = "50 %" }
HoldAttitude read_attitude(const Table& t) {
  constexpr double kMost_rad = 1.0;
  const Table a = t.table("attitude");
  HoldAttitude hold;
  hold.roll_rad = a.quantity_or("roll", Dimension::angle, 0.0, between(-kMost_rad, kMost_rad));
  hold.pitch_rad = a.quantity_or("pitch", Dimension::angle, 0.0, between(-kMost_rad, kMost_rad));
  hold.yaw_rad = maybe(a, "yaw", Dimension::angle);
  hold.yaw_rate_radps = a.quantity_or("yaw_rate", Dimension::angular_rate, 0.0);
  hold.thrust = t.quantity_or("thrust", Dimension::ratio, hold.thrust, between(0.0, 1.0));
  return hold;
}

// { roll = "20 %", thrust = "50 %", mode = 2, arm = true }
Sticks read_sticks(const Table& t) {
  Sticks sticks;
  const lua::Range travel = between(-1.0, 1.0);
  sticks.roll = maybe(t, "roll", Dimension::ratio, travel);
  sticks.pitch = maybe(t, "pitch", Dimension::ratio, travel);
  sticks.yaw = maybe(t, "yaw", Dimension::ratio, travel);
  sticks.thrust = maybe(t, "thrust", Dimension::ratio, between(0.0, 1.0));
  if (t.has("mode")) sticks.mode = static_cast<int>(t.integer("mode", 1, 3));
  if (t.has("arm")) sticks.arm = t.flag_or("arm", false);
  sticks.transmitter_on = t.flag_or("on", true);
  return sticks;
}

// { bytes = "5A 03 C1", read = 6, times = 10, every = "20 ms", shift = "7 us" }
RawTransfer read_raw(const Table& t) {
  RawTransfer raw;
  std::istringstream words(t.text_or("bytes", ""));
  for (std::string word; words >> word;) {
    unsigned byte = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), byte, 16);
    if (error != std::errc{} || end != word.data() + word.size() || byte > 0xFF) {
      t.refuse("bytes", "'" + word + "' is no byte", "write them as \"5A 03 C1\"");
    }
    raw.write.push_back(static_cast<std::uint8_t>(byte));
  }
  raw.read = static_cast<std::uint16_t>(t.integer_or("read", 0, 0, 255));
  raw.times = t.integer_or("times", 1, 1, 1'000'000);
  raw.every_ns = t.duration_ns_or("every", raw.every_ns);
  raw.shift_ns = t.duration_ns_or("shift", 0);
  if (raw.write.empty() && raw.read == 0) {
    t.refuse("bytes", "nothing to write and nothing to read");
  }
  return raw;
}

// { width = "1500 us", rate = "50 Hz", glitch = "50 us", glitch_after = "600 us" }
Pulses read_pulses(const Table& t) {
  Pulses pulses;
  pulses.width_ns = t.duration_ns("width");
  pulses.period_ns = std::llround(
      1e9 / std::max(1.0, t.quantity_or("rate", Dimension::frequency, 50.0, between(1.0, 2000.0))));
  pulses.glitch_ns = t.duration_ns_or("glitch", 0);
  pulses.glitch_after_ns = t.duration_ns_or("glitch_after", 0);
  if (pulses.width_ns >= pulses.period_ns) t.refuse("width", "longer than the period");
  if (pulses.glitch_ns + pulses.glitch_after_ns >= pulses.period_ns) {
    t.refuse("glitch_after", "beyond the period");
  }
  return pulses;
}

// { name = "EST_FILTER", value = 1 }; without a value it is only asked for.
SetParameter read_parameter(const Table& t) {
  constexpr double kMost = std::numeric_limits<float>::max();
  SetParameter parameter;
  parameter.name = t.text("name");
  if (parameter.name.empty() || parameter.name.size() > 16 || !is_one_line(parameter.name)) {
    t.refuse("name", "is not 1 to 16 ASCII characters");
  }
  if (t.has("value")) parameter.value = t.number("value", between(-kMost, kMost));
  return parameter;
}

// radio = "fd090000...": hexadecimal digits, two a byte.
Radio read_radio(const Table& t) {
  constexpr std::size_t kLongest_frame_B = 280;
  const std::string digits = t.text("radio");
  Radio radio;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    unsigned byte = 0;
    const char* end = digits.data() + std::min(i + 2, digits.size());
    const auto [read, error] = std::from_chars(digits.data() + i, end, byte, 16);
    if (error != std::errc{} || read != digits.data() + i + 2) {
      t.refuse("radio", "is not made of bytes of two hexadecimal digits");
      return radio;
    }
    radio.bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  if (radio.bytes.empty() || radio.bytes.size() > kLongest_frame_B) {
    t.refuse("radio", "is not 1 to 280 bytes, the longest frame");
  }
  return radio;
}

// "square.txt" or { file = "square.txt", speed = "0.5 m/s", within = "10 cm" }
Waypoints read_waypoints(const Table& t, const ReadFile& read_file) {
  Waypoints all;
  std::string name;
  if (t.kind("waypoints") == lua::Kind::table) {
    const Table w = t.table("waypoints");
    name = w.text("file");
    all.speed_mps = w.quantity_or("speed", Dimension::speed, all.speed_mps, above(0.0));
    all.within_m = w.quantity_or("within", Dimension::length, all.within_m, above(0.0));
  } else {
    name = t.text("waypoints");
  }
  const auto text = read_file
                        ? read_file(name)
                        : Error{ErrorKind::bad_input, "", "'" + name + "' cannot be read", ""};
  if (!text) {
    t.refuse("waypoints", text.error().what);
    return all;
  }
  auto points = waypoints_of(name, text.value());
  if (!points) {
    t.refuse("waypoints", points.error().place + ": " + points.error().what, points.error().cure);
    return all;
  }
  all.points = std::move(points.value());
  return all;
}

// { reaction = "250 ms", script = { { at = "0 s", north = "0.5 m/s" }, { at = "3 s", yaw_rate = "30 deg/s" } } }
Teleoperation read_teleoperation(const Table& t) {
  const lua::Range speed = between(-20.0, 20.0);
  Teleoperation all;
  all.reaction_s = t.quantity_or("reaction", Dimension::time, all.reaction_s, between(0.0, 2.0));
  for (const Table& s : t.tables("script")) {
    const double at_s = s.quantity("at", Dimension::time, at_least(0.0));
    if (!all.script.empty() && !(at_s > all.script.back().at_s)) {
      s.refuse("at", "is not later than the one before");
    }
    all.script.push_back({at_s, maybe(s, "north", Dimension::speed, speed),
                          maybe(s, "east", Dimension::speed, speed),
                          maybe(s, "height", Dimension::length, above(0.0)),
                          maybe(s, "yaw_rate", Dimension::angular_rate, between(-10.0, 10.0))});
  }
  if (all.script.empty())
    t.refuse("script", "is empty", "{ { at = \"0 s\", north = \"0.5 m/s\" } }");
  return all;
}

Calibrate read_calibrate(const Table& t) {
  // In the order of request::Calibration.
  static const std::vector<std::string> kWords = {"gyroscope", "accelerometer", "magnetometer",
                                                  "motor_fields", "cancel"};
  const std::string word = t.choice("calibrate", kWords);
  const auto found = std::find(kWords.begin(), kWords.end(), word);
  return {static_cast<Calibration>(found - kWords.begin())};
}

void read_flying(const Table& t, const ReadFile& read_file, std::vector<Command>& all) {
  if (t.has("arm")) all.emplace_back(Arm{t.flag_or("arm", true), t.flag_or("force", false)});
  if (t.has("takeoff")) {
    all.emplace_back(TakeOff{t.quantity("takeoff", Dimension::length, above(0.0))});
  }
  if (t.has("position") || t.has("yaw")) all.emplace_back(read_go_to(t));
  if (t.has("figure_8")) all.emplace_back(read_figure_8(t.table("figure_8")));
  if (t.has("velocity")) all.emplace_back(read_cruise(t.table("velocity")));
  if (t.has("attitude")) all.emplace_back(read_attitude(t));
  if (t.has("waypoints")) all.emplace_back(read_waypoints(t, read_file));
  if (t.has("teleoperation")) all.emplace_back(read_teleoperation(t.table("teleoperation")));
  if (t.has("radio")) all.emplace_back(read_radio(t));
  if (t.has("land") && t.flag_or("land", true)) all.emplace_back(Land{});
  if (t.has("parameter")) all.emplace_back(read_parameter(t.table("parameter")));
  if (t.has("rc")) all.emplace_back(read_sticks(t.table("rc")));
  if (t.has("calibrate")) all.emplace_back(read_calibrate(t));
}

void read_turning(const Table& t, std::vector<Command>& all) {
  const struct {
    const char* key;
    Dimension dimension;
    SetPointKind kind;
  } set_points[] = {{"duty", Dimension::ratio, SetPointKind::duty},
                    {"speed", Dimension::angular_rate, SetPointKind::speed},
                    {"thrust", Dimension::force, SetPointKind::thrust},
                    {"power", Dimension::power, SetPointKind::power}};
  // A speed beside a place is how fast to go there, a thrust beside an attitude belongs to it.
  const bool goes = t.has("position") || t.has("yaw"), tilts = t.has("attitude");
  for (const auto& s : set_points) {
    if (!t.has(s.key) || (goes && s.kind == SetPointKind::speed)) continue;
    if (tilts && s.kind == SetPointKind::thrust) continue;
    all.emplace_back(SetPoint{s.kind, t.quantity(s.key, s.dimension, at_least(0.0))});
  }
  if (t.has("stop") && t.flag_or("stop", true)) all.emplace_back(Stop{});
  if (t.has("silence")) all.emplace_back(Silence{t.flag_or("silence", true)});
  if (t.has("i2c_raw")) all.emplace_back(read_raw(t.table("i2c_raw")));
  if (t.has("setpoint_rate")) {
    all.emplace_back(
        SetPointRate{t.quantity("setpoint_rate", Dimension::frequency, between(1.0, 10e3))});
  }
  if (t.has("pulses")) all.emplace_back(read_pulses(t.table("pulses")));
  if (t.has("line")) all.emplace_back(Line{typed_line(t)});
  if (t.has("brake")) {
    all.emplace_back(Brake{t.quantity("brake", Dimension::torque, between(-1.0, 10.0))});
  }
}

Jet read_jet(const Table& t) {
  Jet jet;
  jet.up_mps = t.quantity("up", Dimension::speed);
  jet.north_m = t.quantity_or("north", Dimension::length, 0.0);
  jet.east_m = t.quantity_or("east", Dimension::length, 0.0);
  jet.radius_m = t.quantity("radius", Dimension::length, above(0.0));
  jet.edge_m = maybe(t, "edge", Dimension::length, above(0.0));
  return jet;
}

// { field = { north = "20 uT" }, at = { north = "1 m", height = "1 m" }, radius = "50 cm" }
Magnet read_magnet(const Table& t) {
  constexpr double kMost_T = 10e-3;
  Magnet magnet;
  const Table field = t.table("field");
  const auto along = [&field](const char* key) {
    return field.quantity_or(key, Dimension::magnetic_field, 0.0, between(-kMost_T, kMost_T));
  };
  magnet.north_T = along("north");
  magnet.east_T = along("east");
  magnet.down_T = along("down");
  magnet.radius_m = maybe(t, "radius", Dimension::length, above(0.0));
  magnet.duration_s = maybe(t, "duration", Dimension::time, above(0.0));
  if (t.has("at") != t.has("radius"))
    t.refuse("radius", "a place has a radius, and a radius a place");
  if (!t.has("at")) return magnet;
  const Table at = t.table("at");
  magnet.at_north_m = at.quantity_or("north", Dimension::length, 0.0);
  magnet.at_east_m = at.quantity_or("east", Dimension::length, 0.0);
  magnet.at_height_m = at.quantity_or("height", Dimension::length, 0.0);
  return magnet;
}

// { roll = "90 deg", height = "1 m", over = "2 s" }: level, nose north, where nothing is said.
Hold read_hold(const Table& t) {
  constexpr double kTurns_rad = 100.0, kFar_m = 1000.0;
  const lua::Range turn = between(-kTurns_rad, kTurns_rad), place = between(-kFar_m, kFar_m);
  Hold hold;
  hold.roll_rad = t.quantity_or("roll", Dimension::angle, 0.0, turn);
  hold.pitch_rad = t.quantity_or("pitch", Dimension::angle, 0.0, turn);
  hold.yaw_rad = t.quantity_or("yaw", Dimension::angle, 0.0, turn);
  hold.height_m = maybe(t, "height", Dimension::length, between(1e-3, kFar_m));
  hold.north_m = maybe(t, "north", Dimension::length, place);
  hold.east_m = maybe(t, "east", Dimension::length, place);
  hold.over_s = t.quantity_or("over", Dimension::time, hold.over_s, between(0.2, 60.0));
  return hold;
}

Wind read_wind(const Table& t) {
  const lua::Range time = between(0.0, 1e9);
  return {maybe(t, "north", Dimension::speed),     maybe(t, "east", Dimension::speed),
          maybe(t, "down", Dimension::speed),      maybe(t, "duration", Dimension::time, time),
          maybe(t, "edge", Dimension::time, time), maybe(t, "after", Dimension::time, time)};
}

Disturbance read_any(const Table& t) {
  if (t.has("jet")) return read_jet(t.table("jet"));
  if (t.has("magnet")) return read_magnet(t.table("magnet"));
  return read_wind(t);
}

// A world's refusal with the line of the plan: its place is the key.
Result<Done> placed(const lua::Table& t, Result<Done> done) {
  if (done || done.error().place.empty() || done.error().kind != ErrorKind::bad_input) return done;
  t.refuse(done.error().place, done.error().what, done.error().cure);
  return t.finish();
}

}  // namespace

bool is_one_line(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

Result<std::vector<Command>> read_commands(const Table& t, const ReadFile& read_file) {
  std::vector<Command> all;
  read_flying(t, read_file, all);
  read_turning(t, all);
  refuse_contradictions(t, all);
  if (auto good = t.finish(); !good) return good.error();
  if (!all.empty()) return all;
  t.refuse("command", "is empty: nothing is commanded");
  return t.finish().error();
}

Result<Disturbance> read_disturbance(const Table& t) {
  const Disturbance all = read_any(t);
  if (auto good = t.finish(); !good) return good.error();
  return all;
}

Result<Done> command(World& world, const Table& t, std::int64_t now_ns, const ReadFile& read_file) {
  const auto commands = read_commands(t, read_file);
  if (!commands) return commands.error();
  for (const Command& one : commands.value()) {
    if (auto done = placed(t, world.command(one, now_ns)); !done) return done;
  }
  return Done{};
}

Result<Done> disturb(World& world, const Table& t, std::int64_t now_ns) {
  const auto disturbance = read_disturbance(t);
  if (!disturbance) return disturbance.error();
  return placed(t, world.disturb(disturbance.value(), now_ns));
}

Result<Done> hold(World& world, const Table& t, std::int64_t now_ns) {
  const Hold wanted = read_hold(t);
  if (auto good = t.finish(); !good) return good;
  return placed(t, world.disturb(wanted, now_ns));
}

Result<Done> release(World& world, const Table& t, std::int64_t now_ns) {
  const Release wanted{maybe(t, "over", Dimension::time, between(0.2, 60.0))};
  if (auto good = t.finish(); !good) return good;
  return placed(t, world.disturb(wanted, now_ns));
}

}  // namespace whirl::plan

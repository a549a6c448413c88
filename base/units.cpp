#include "base/units.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace whirl {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLongest_ns = 1e18;  // so that two of them still add up

struct Unit {
  std::string_view symbol;
  Dimension dimension;
  double scale;
  double offset_SI = 0.0;
};

constexpr std::array kUnits{
    Unit{"%", Dimension::ratio, 0.01},
    Unit{"ppm", Dimension::ratio, 1e-6},
    Unit{"ns", Dimension::time, 1e-9},
    Unit{"us", Dimension::time, 1e-6},
    Unit{"ms", Dimension::time, 1e-3},
    Unit{"s", Dimension::time, 1.0},
    Unit{"min", Dimension::time, 60.0},
    Unit{"Hz", Dimension::frequency, 1.0},
    Unit{"kHz", Dimension::frequency, 1e3},
    Unit{"MHz", Dimension::frequency, 1e6},
    Unit{"mm", Dimension::length, 1e-3},
    Unit{"cm", Dimension::length, 1e-2},
    Unit{"m", Dimension::length, 1.0},
    Unit{"km", Dimension::length, 1e3},
    Unit{"in", Dimension::length, 0.0254},
    Unit{"m/s", Dimension::speed, 1.0},
    Unit{"cm/s", Dimension::speed, 1e-2},
    Unit{"km/h", Dimension::speed, 1.0 / 3.6},
    Unit{"m/s2", Dimension::acceleration, 1.0},
    Unit{"g0", Dimension::acceleration, 9.80665},
    Unit{"rad", Dimension::angle, 1.0},
    Unit{"deg", Dimension::angle, kPi / 180.0},
    Unit{"rad/s", Dimension::angular_rate, 1.0},
    Unit{"deg/s", Dimension::angular_rate, kPi / 180.0},
    Unit{"rpm", Dimension::angular_rate, 2.0 * kPi / 60.0},
    Unit{"g", Dimension::mass, 1e-3},
    Unit{"kg", Dimension::mass, 1.0},
    Unit{"kg m2", Dimension::inertia, 1.0},
    Unit{"g cm2", Dimension::inertia, 1e-7},
    Unit{"N", Dimension::force, 1.0},
    Unit{"mN", Dimension::force, 1e-3},
    Unit{"N m", Dimension::torque, 1.0},
    Unit{"mN m", Dimension::torque, 1e-3},
    Unit{"Pa", Dimension::pressure, 1.0},
    Unit{"hPa", Dimension::pressure, 100.0},
    Unit{"kPa", Dimension::pressure, 1e3},
    Unit{"mV", Dimension::voltage, 1e-3},
    Unit{"V", Dimension::voltage, 1.0},
    Unit{"uA", Dimension::current, 1e-6},
    Unit{"mA", Dimension::current, 1e-3},
    Unit{"A", Dimension::current, 1.0},
    Unit{"mohm", Dimension::resistance, 1e-3},
    Unit{"ohm", Dimension::resistance, 1.0},
    Unit{"uH", Dimension::inductance, 1e-6},
    Unit{"mH", Dimension::inductance, 1e-3},
    Unit{"H", Dimension::inductance, 1.0},
    Unit{"mAh", Dimension::charge, 3.6},
    Unit{"Ah", Dimension::charge, 3600.0},
    Unit{"C", Dimension::charge, 1.0},
    Unit{"mW", Dimension::power, 1e-3},
    Unit{"W", Dimension::power, 1.0},
    Unit{"J", Dimension::energy, 1.0},
    Unit{"Wh", Dimension::energy, 3600.0},
    Unit{"K", Dimension::temperature, 1.0},
    Unit{"degC", Dimension::temperature, 1.0, 273.15},
    Unit{"K/m", Dimension::temperature_gradient, 1.0},
    Unit{"K/km", Dimension::temperature_gradient, 1e-3},
    Unit{"kg/m3", Dimension::density, 1.0},
    Unit{"B", Dimension::data, 1.0},
    Unit{"KiB", Dimension::data, 1024.0},
    Unit{"MiB", Dimension::data, 1048576.0},
    Unit{"baud", Dimension::baud, 1.0},
    Unit{"T", Dimension::magnetic_field, 1.0},
    Unit{"uT", Dimension::magnetic_field, 1e-6},
    Unit{"Gauss", Dimension::magnetic_field, 1e-4},
};

struct Word {
  Dimension dimension;
  const char* name;
  const char* symbol;  // of the SI unit
  const char* suffix;  // the same as the end of a name
};

constexpr std::array kWords{
    Word{Dimension::none, "number", "", ""},
    Word{Dimension::ratio, "ratio", "", ""},
    Word{Dimension::time, "time", "s", "s"},
    Word{Dimension::frequency, "frequency", "Hz", "Hz"},
    Word{Dimension::length, "length", "m", "m"},
    Word{Dimension::speed, "speed", "m/s", "mps"},
    Word{Dimension::acceleration, "acceleration", "m/s2", "mps2"},
    Word{Dimension::angle, "angle", "rad", "rad"},
    Word{Dimension::angular_rate, "angular rate", "rad/s", "radps"},
    Word{Dimension::mass, "mass", "kg", "kg"},
    Word{Dimension::inertia, "moment of inertia", "kg m2", "kgm2"},
    Word{Dimension::force, "force", "N", "N"},
    Word{Dimension::torque, "torque", "N m", "Nm"},
    Word{Dimension::pressure, "pressure", "Pa", "Pa"},
    Word{Dimension::voltage, "voltage", "V", "V"},
    Word{Dimension::current, "current", "A", "A"},
    Word{Dimension::resistance, "resistance", "ohm", "ohm"},
    Word{Dimension::inductance, "inductance", "H", "H"},
    Word{Dimension::charge, "charge", "C", "C"},
    Word{Dimension::power, "power", "W", "W"},
    Word{Dimension::energy, "energy", "J", "J"},
    Word{Dimension::temperature, "temperature", "K", "K"},
    Word{Dimension::temperature_gradient, "temperature gradient", "K/m", "Kpm"},
    Word{Dimension::density, "density", "kg/m3", "kgpm3"},
    Word{Dimension::data, "data size", "B", "B"},
    Word{Dimension::baud, "baud rate", "baud", "baud"},
    Word{Dimension::magnetic_field, "magnetic field", "T", "T"},
};

const Word& word(Dimension dimension) {
  for (const Word& entry : kWords) {
    if (entry.dimension == dimension) return entry;
  }
  return kWords[0];
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

Error bad(std::string_view place, std::string what, std::string cure = {}) {
  return {ErrorKind::bad_input, std::string(place), std::move(what), std::move(cure)};
}

std::string quoted(std::string_view text) {
  return "'" + std::string(text) + "'";
}

// from_chars takes no sign of plus, people write it: "+12 %".
std::from_chars_result read_number(std::string_view body, double& number) {
  const bool plus = body.size() > 1 && body[0] == '+' && body[1] != '-' && body[1] != '+';
  return std::from_chars(body.data() + (plus ? 1 : 0), body.data() + body.size(), number);
}

}  // namespace

const char* name(Dimension dimension) {
  return word(dimension).name;
}

const char* si_symbol(Dimension dimension) {
  return word(dimension).symbol;
}

const char* si_suffix(Dimension dimension) {
  return word(dimension).suffix;
}

std::string unit_symbol(std::string_view text) {
  const std::string_view body = trimmed(text);
  double number = 0.0;
  const char* end = read_number(body, number).ptr;
  return std::string(trimmed({end, body.data() + body.size()}));
}

double in_unit(double value_SI, std::string_view symbol) {
  if (symbol.empty()) return value_SI;
  for (const Unit& unit : kUnits) {
    if (unit.symbol == symbol) return (value_SI - unit.offset_SI) / unit.scale;
  }
  return std::nan("");
}

std::vector<std::string_view> units_of(Dimension dimension) {
  std::vector<std::string_view> found;
  for (const Unit& unit : kUnits) {
    if (unit.dimension == dimension) found.push_back(unit.symbol);
  }
  return found;
}

Result<Quantity> parse_quantity(std::string_view text, std::string_view place) {
  const std::string_view body = trimmed(text);
  double number = 0.0;
  const auto [end, status] = read_number(body, number);
  if (status != std::errc{} || !std::isfinite(number)) {
    return bad(place, quoted(text) + " does not start with a number", "write it as \"50 ms\"");
  }
  const std::string_view symbol = trimmed({end, body.data() + body.size()});
  if (symbol.empty()) return Quantity{number, Dimension::none};
  for (const Unit& unit : kUnits) {
    if (unit.symbol != symbol) continue;
    const double value_SI = number * unit.scale + unit.offset_SI;
    if (!std::isfinite(value_SI)) return bad(place, quoted(text) + " is too large");
    return Quantity{value_SI, unit.dimension};
  }
  return bad(place, "unknown unit " + quoted(symbol) + " in " + quoted(text));
}

Result<double> parse_quantity_as(std::string_view text, Dimension wanted, std::string_view place) {
  const auto quantity = parse_quantity(text, place);
  if (!quantity) return quantity.error();
  if (quantity.value().dimension == wanted) return quantity.value().value_SI;
  std::string cure = "a " + std::string(name(wanted)) + " is written with";
  for (std::string_view symbol : units_of(wanted)) cure += " " + std::string(symbol);
  if (wanted == Dimension::none) cure = "a bare number is wanted";
  return bad(place,
             quoted(text) + " is a " + name(quantity.value().dimension) + ", not a " + name(wanted),
             cure);
}

Result<std::int64_t> parse_duration_ns(std::string_view text, std::string_view place) {
  const auto seconds = parse_quantity_as(text, Dimension::time, place);
  if (!seconds) return seconds.error();
  const double ns = seconds.value() * 1e9;
  if (!(std::abs(ns) <= kLongest_ns)) return bad(place, quoted(text) + " is too long a time");
  return static_cast<std::int64_t>(std::llround(ns));
}

}  // namespace whirl

// Quantities as people write them: "50 ms", "3.2 N", "4.2 m/s", "10 %".
//
//   Out     a real number in the SI unit of its dimension (percent: 1 = 100 %; angle: rad; rotor
//           speed "4500 rpm": rad/s; temperature "25 degC": K), and the dimension
//   Errors  bad_input: no number, unknown unit, trailing text, not finite
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace whirl {

enum class Dimension {
  none,  // a bare number
  ratio,
  time,
  frequency,
  length,
  speed,
  acceleration,
  angle,
  angular_rate,
  mass,
  inertia,
  force,
  torque,
  pressure,
  voltage,
  current,
  resistance,
  inductance,
  charge,
  power,
  energy,
  temperature,
  temperature_gradient,  // over height
  density,
  data,
  baud,
  magnetic_field,
};

struct Quantity {
  double value_SI = 0.0;
  Dimension dimension = Dimension::none;
};

const char* name(Dimension dimension);

// `place` is repeated in the error ("hover.lua:12").
Result<Quantity> parse_quantity(std::string_view text, std::string_view place);

// The same, and the dimension must be the wanted one. Error says which units would do.
Result<double> parse_quantity_as(std::string_view text, Dimension wanted, std::string_view place);

// Time as integer nanoseconds; refuses what is longer than 1e9 s.
Result<std::int64_t> parse_duration_ns(std::string_view text, std::string_view place);

std::vector<std::string_view> units_of(Dimension dimension);

// The way back, for what people read. The symbol of "50 ms" is "ms"; that of a bare number is "".
std::string unit_symbol(std::string_view quantity_text);
double in_unit(double value_SI, std::string_view symbol);  // NaN for a symbol that is not known
const char* si_symbol(Dimension dimension);                // "m/s"; "" for ratio and none
const char* si_suffix(Dimension dimension);                // of a name: "mps"; "" likewise

}  // namespace whirl

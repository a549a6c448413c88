// A tolerance is a number, a unit (in the name of the maker) and a reason. Tests compare reals by it
// (near.hpp) or exactly, which cmake/gates/reals.sh sees to. NaN never passes: the comparison is written
// as diff <= limit.
#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace whirl {

struct Tolerance {
  double limit;
  std::string why;
};

// n units in the last place at the size of the largest term that enters the sum.
inline Tolerance round_off(int n, double scale) {
  return {n * std::numeric_limits<double>::epsilon() * std::abs(scale),
          std::to_string(n) + " ulp at scale " + std::to_string(scale)};
}
// Half of the last digit that the publication prints.
inline Tolerance printed_to(double last_digit) {
  return {0.5 * last_digit, "printed rounding"};
}
// The device cannot resolve better than this.
inline Tolerance counts(double n, double unit_per_count) {
  return {n * unit_per_count, std::to_string(n) + " LSB"};
}
inline Tolerance stated(double limit, std::string why) {
  return {limit, std::move(why)};
}

}  // namespace whirl

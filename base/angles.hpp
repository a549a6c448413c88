// The circle's constant; a degree and a revolution per minute in SI. Of speeds, rpm.hpp has both ways.
#pragma once
#include <numbers>

namespace whirl {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDeg = kPi / 180.0;  // rad
inline constexpr double kRadps_per_rpm = kPi / 30.0;

}  // namespace whirl

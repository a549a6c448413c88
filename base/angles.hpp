// The circle's constant; a degree and a revolution per minute in SI. Of speeds, rpm.hpp has both ways.
#pragma once

namespace whirl {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDeg = kPi / 180.0;  // rad
inline constexpr double kRadps_per_rpm = kPi / 30.0;

}  // namespace whirl

// What a master may ask of the ESC: modes, their ranges, and the 11-bit set-point on the wire.
//
//   Units   SI inside; rpm and percent only in the table of ranges, where the protocol names them
//   Source  [Bangura 2017, table 3.3]; protocol: README, "ESC on I2C"
#pragma once
#include <cstdint>

namespace fw::esc {

enum class Mode : std::uint8_t {
  duty = 0,             // open loop, share of bus voltage
  speed = 1,            // RPM
  thrust_by_speed = 2,  // static thrust map solved for RPM
  servo = 3,            // not for a propeller: refused
  power = 4,            // aerodynamic mechanical power
  thrust_by_power = 5,  // "st": thrust from power and speed, Algorithm 1
};

// What it gives is read off its power, and so off the current.
constexpr bool goes_by_power(Mode mode) {
  return mode == Mode::power || mode == Mode::thrust_by_power;
}

struct Range {
  float min, max;
};

inline constexpr float kRadps_per_rpm = 0.10471976f;
inline constexpr std::uint16_t kSetpointMax = 2047;

// Duty as a share, speed in rad/s, thrust in N, power in W. servo: an empty range.
constexpr Range range_of(Mode mode) {
  switch (mode) {
    case Mode::duty:
      return {0.05f, 1.0f};
    case Mode::speed:
      return {1000.0f * kRadps_per_rpm, 6000.0f * kRadps_per_rpm};
    case Mode::thrust_by_speed:
      return {0.8f, 8.0f};
    case Mode::servo:
      return {0.0f, 0.0f};
    case Mode::power:
      return {2.6f, 60.0f};
    case Mode::thrust_by_power:
      return {0.6f, 8.0f};
  }
  return {0.0f, 0.0f};
}

// v = 1..2047 spans the range linearly; v = 0 means stop and has no value. Pre: v >= 1.
constexpr float value_of(Mode mode, std::uint16_t v) {
  const Range range = range_of(mode);
  return range.min + static_cast<float>(v - 1) / 2046.0f * (range.max - range.min);
}

}  // namespace fw::esc

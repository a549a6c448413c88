// The ESC's bytes on I2C: the set-point that a master writes and the status that it reads.
//
//   Set-point  hi, lo, crc: v = hi << 3 | lo, 11 bits; crc over (address << 1), hi, lo
//   Status     current in mA (int16 LE), mechanical RPM (uint16 LE), flags, crc over
//              (address << 1 | 1) and the five bytes
//   Scaling    v = 0 stops; v = 1..2047 spans the mode's range linearly
//   Units      as asked for over the wire: percent, RPM, newton, degree, watt (range_of().unit)
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "io_bridges/devices/core/esc_i2c.hpp"

namespace whirl::io {

enum class EscMode : std::uint8_t {
  duty = 0,
  rpm = 1,
  thrust_by_rpm = 2,
  servo = 3,
  power = 4,
  thrust_by_power = 5,
};

struct EscRange {
  double min;
  double max;
  const char* unit;
};

// Flags of the status byte.
struct EscFlag {
  static constexpr std::uint8_t kArmed = 1u << 0;
  static constexpr std::uint8_t kTurning = 1u << 1;
  static constexpr std::uint8_t kSaturated = 1u << 2;
  static constexpr std::uint8_t kOverCurrent = 1u << 3;
  static constexpr std::uint8_t kUnderVoltage = 1u << 4;
  static constexpr std::uint8_t kDesync = 1u << 5;
  static constexpr std::uint8_t kUncalibrated = 1u << 6;
  static constexpr std::uint8_t kWriteRejected = 1u << 7;
};

struct EscStatus {
  double bus_current_A = 0.0;
  double speed_rpm = 0.0;
  std::uint8_t flags = 0;
};

inline constexpr std::uint16_t kEscMaxSetpoint = 2047;

constexpr std::uint8_t esc_address(int motor) {
  return static_cast<std::uint8_t>(0x28 + motor);
}

EscRange range_of(EscMode mode);
// Value in the mode's unit; v = 0 has none. Pre: 1 <= v <= 2047.
double value_of_setpoint(EscMode mode, std::uint16_t v);
// Nearest v for a value, bounded to 1..2047.
std::uint16_t setpoint_of_value(EscMode mode, double value);

std::array<std::uint8_t, 3> pack_setpoint(std::uint8_t address, std::uint16_t v);
// Nothing when the length, the CRC or the upper bits of lo are wrong.
std::optional<std::uint16_t> unpack_setpoint(std::uint8_t address,
                                             std::span<const std::uint8_t> bytes);

core::EscStatusCounts counts_of(const EscStatus& status);  // as on the wire, bounded to it
std::array<std::uint8_t, 6> pack_status(std::uint8_t address, const EscStatus& status);
std::optional<EscStatus> unpack_status(std::uint8_t address, std::span<const std::uint8_t> bytes);

}  // namespace whirl::io

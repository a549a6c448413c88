#include "io_bridges/protocols/esc_codec.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "io_bridges/devices/core/esc_i2c.hpp"

namespace whirl::io {
EscRange range_of(EscMode mode) {
  switch (mode) {
    case EscMode::duty:
      return {5.0, 100.0, "%"};
    case EscMode::rpm:
      return {1000.0, 6000.0, "rpm"};
    case EscMode::thrust_by_rpm:
      return {0.8, 8.0, "N"};
    case EscMode::servo:
      return {0.0, 360.0, "deg"};
    case EscMode::power:
      return {2.6, 60.0, "W"};
    case EscMode::thrust_by_power:
      return {0.6, 8.0, "N"};
  }
  WHIRL_CHECK(false, static_cast<int>(mode));
}

double value_of_setpoint(EscMode mode, std::uint16_t v) {
  WHIRL_CHECK(v >= 1 && v <= kEscMaxSetpoint, v);
  const EscRange range = range_of(mode);
  return range.min + (v - 1) / 2046.0 * (range.max - range.min);
}

std::uint16_t setpoint_of_value(EscMode mode, double value) {
  WHIRL_CHECK(std::isfinite(value), value);
  const EscRange range = range_of(mode);
  const double v = 1.0 + 2046.0 * (value - range.min) / (range.max - range.min);
  return static_cast<std::uint16_t>(std::lround(std::clamp(v, 1.0, 2047.0)));
}

std::array<std::uint8_t, 3> pack_setpoint(std::uint8_t address, std::uint16_t v) {
  WHIRL_CHECK(v <= kEscMaxSetpoint, v);
  std::array<std::uint8_t, 3> bytes{static_cast<std::uint8_t>(v >> 3),
                                    static_cast<std::uint8_t>(v & 7), 0};
  bytes[2] = core::esc_crc(address, false, std::span(bytes).first(2));
  return bytes;
}

std::optional<std::uint16_t> unpack_setpoint(std::uint8_t address,
                                             std::span<const std::uint8_t> bytes) {
  return core::esc_setpoint(address, bytes);
}

core::EscStatusCounts counts_of(const EscStatus& status) {
  const long current_mA = std::lround(std::clamp(status.bus_current_A, -32.768, 32.767) * 1000.0);
  const long rpm = std::lround(std::clamp(status.speed_rpm, 0.0, 65535.0));
  return {static_cast<std::int16_t>(current_mA), static_cast<std::uint16_t>(rpm), status.flags};
}

std::array<std::uint8_t, 6> pack_status(std::uint8_t address, const EscStatus& status) {
  return core::esc_status(address, counts_of(status));
}

std::optional<EscStatus> unpack_status(std::uint8_t address, std::span<const std::uint8_t> bytes) {
  if (bytes.size() != 6 || bytes[5] != core::esc_crc(address, true, bytes.first(5)))
    return std::nullopt;
  const auto current_mA = static_cast<std::int16_t>(bytes[0] | bytes[1] << 8);
  return EscStatus{current_mA / 1000.0, static_cast<double>(bytes[2] | bytes[3] << 8), bytes[4]};
}

}  // namespace whirl::io

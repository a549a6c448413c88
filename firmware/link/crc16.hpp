// CRC-16/MCRF4XX, byte by byte: X.25's polynomial without its final inversion. MAVLink and the ESC's
// stream use it; both start from 0xFFFF and send the low byte first.
#pragma once
#include <cstdint>

namespace fw {

inline constexpr std::uint16_t kCrcStart = 0xFFFF;

constexpr std::uint16_t crc_add(std::uint16_t crc, std::uint8_t byte) {
  auto x = static_cast<std::uint8_t>(byte ^ (crc & 0xFF));
  x = static_cast<std::uint8_t>(x ^ (x << 4));
  return static_cast<std::uint16_t>((crc >> 8) ^ (x << 8) ^ (x << 3) ^ (x >> 4));
}

}  // namespace fw

// CRC-8/SMBUS: polynomial 0x07, start 0, not reflected (the ESCs' set-points and status).
#pragma once
#include <cstdint>

namespace whirl::core {

constexpr std::uint8_t crc8_add(std::uint8_t crc, std::uint8_t byte) {
  crc = static_cast<std::uint8_t>(crc ^ byte);
  for (int bit = 0; bit < 8; ++bit) {
    crc = static_cast<std::uint8_t>((crc & 0x80) != 0 ? (crc << 1) ^ 0x07 : crc << 1);
  }
  return crc;
}

}  // namespace whirl::core

// CRC-32 of ISO 3309 (reflected 0x04C11DB7), as in Ethernet: what is kept in flash is told whole by it.
#pragma once
#include <cstdint>
#include <string_view>

namespace fw {

// The caller inverts at the end.
inline constexpr std::uint32_t kCrc32Start = 0xFFFF'FFFF;
constexpr std::uint32_t crc32_add(std::uint32_t crc, std::uint8_t byte) {
  crc ^= byte;
  for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB8'8320u : 0u);
  return crc;
}
constexpr std::uint32_t crc32_add_word(std::uint32_t crc, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) {
    crc = crc32_add(crc, static_cast<std::uint8_t>(word >> shift));
  }
  return crc;
}
constexpr std::uint32_t crc32_of(std::string_view text) {
  std::uint32_t crc = kCrc32Start;
  for (const char letter : text) crc = crc32_add(crc, static_cast<std::uint8_t>(letter));
  return ~crc;
}

}  // namespace fw

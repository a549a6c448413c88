// One set of parameters as words of flash, and the CRC by which a whole record is told from a torn one.
//
//   Words   magic and number of entries | generation | erases so far | CRC-32 of a name, bits of its
//           value .. | CRC-32 of all words before, the last to be written
//   Kept    what differs from the table's start values, so that new defaults reach old vehicles
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "firmware/config/parameters.hpp"

namespace fw {

// CRC-32 of ISO 3309 (reflected 0x04C11DB7), as in Ethernet; the caller inverts at both ends.
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

struct ParameterRecord {
  static constexpr std::uint32_t kMagic = 0x5041'0000, kMagicMask = 0xFFFF'0000;
  static constexpr std::uint32_t kHead = 3, kEntry = 2, kTail = 1;  // words
  static constexpr std::uint32_t kMostWords = kHead + kEntry * kParameterCount + kTail;

  // How long a record is that starts so; 0: none starts so.
  static constexpr std::uint32_t words_of(std::uint32_t first) {
    if ((first & kMagicMask) != kMagic) return 0;
    return kHead + kEntry * (first & ~kMagicMask) + kTail;
  }

  ParameterRecord() = default;
  ParameterRecord(const Parameters& parameters, std::uint32_t generation, std::uint32_t erases);

  std::span<const std::uint32_t> words() const { return {words_.data(), size_}; }

 private:
  std::array<std::uint32_t, kMostWords> words_{};
  std::uint32_t size_ = 0;
};

// An entry of a record; one that no row knows, or whose value its bounds refuse, changes nothing.
void restore(Parameters& parameters, std::uint32_t name_crc, std::uint32_t value_bits);

}  // namespace fw

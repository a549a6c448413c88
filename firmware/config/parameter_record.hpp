// One set of parameters as words of flash, and the CRC by which a whole record is told from a torn one.
//
//   Words   magic and number of entries | generation | erases so far | CRC-32 of a name, bits of its
//           value .. | CRC-32 of all words before, the last to be written
//   Kept    what differs from the table's start values, so that new defaults reach old vehicles
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "firmware/config/parameters.hpp"
#include "firmware/crc32.hpp"

namespace fw {

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

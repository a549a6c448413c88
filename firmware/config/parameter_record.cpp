#include "firmware/config/parameter_record.hpp"

#include <bit>

namespace fw {
namespace {

constexpr auto kNameCrcs = [] {
  std::array<std::uint32_t, kParameterCount> crcs{};
  for (std::size_t i = 0; i < kParameterCount; ++i) crcs[i] = crc32_of(kParameterTable[i].name);
  return crcs;
}();

constexpr bool all_differ() {
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (kNameCrcs[i] == kNameCrcs[k]) return false;
    }
  }
  return true;
}
static_assert(all_differ(), "two names, or their CRCs, are the same");
static_assert(crc32_of("123456789") == 0xCBF4'3926);  // the check value of this CRC

}  // namespace

ParameterRecord::ParameterRecord(const Parameters& parameters, std::uint32_t generation,
                                 std::uint32_t erases) {
  size_ = kHead;
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    if (parameters.value(i) == kParameterTable[i].start) continue;
    words_[size_++] = kNameCrcs[i];
    words_[size_++] = std::bit_cast<std::uint32_t>(parameters.value(i));
  }
  words_[0] = kMagic | (size_ - kHead) / kEntry;
  words_[1] = generation;
  words_[2] = erases;
  std::uint32_t crc = kCrc32Start;
  for (const std::uint32_t word : words()) crc = crc32_add_word(crc, word);
  words_[size_++] = ~crc;
}

void restore(Parameters& parameters, std::uint32_t name_crc, std::uint32_t value_bits) {
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    if (kNameCrcs[i] == name_crc) parameters.set(i, std::bit_cast<float>(value_bits), false);
  }
}

}  // namespace fw

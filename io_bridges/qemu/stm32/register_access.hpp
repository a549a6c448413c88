// Narrow accesses to word registers, as the APB bridges make them: a narrow read is a part of the
// word, a narrow write arrives repeated on all lanes.
#pragma once
#include <cstdint>

namespace whirl::stm32 {

inline std::uint32_t part_of_word(std::uint32_t word, std::uint32_t offset, unsigned size) {
  const std::uint32_t shifted = word >> (8 * (offset & 3));
  return size == 1 ? shifted & 0xFF : size == 2 ? shifted & 0xFFFF : shifted;
}

inline std::uint32_t on_all_lanes(std::uint32_t value, unsigned size) {
  if (size == 1) return (value & 0xFF) * 0x01010101u;
  if (size == 2) return (value & 0xFFFF) * 0x00010001u;
  return value;
}

inline std::uint32_t field(std::uint32_t word, unsigned low, unsigned bits) {
  return (word >> low) & ((1u << bits) - 1);
}

inline bool bit(std::uint32_t word, unsigned n) {
  return ((word >> n) & 1) != 0;
}

// rc_w0: bits of `flags` stay only where 1 is written.
inline void clear_where_zero(std::uint32_t& reg, std::uint32_t flags, std::uint32_t written) {
  reg &= written | ~flags;
}

}  // namespace whirl::stm32

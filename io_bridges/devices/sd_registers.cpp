#include "io_bridges/devices/sd_registers.hpp"

#include <span>

#include "base/check.hpp"
#include "io_bridges/protocols/crc.hpp"

namespace whirl::io::sd {
namespace {

// Bits [high:low] of a register whose bit 127 comes first.
void set_bits(Register& bytes, int high, int low, std::uint32_t value) {
  for (int bit = low; bit <= high; ++bit, value >>= 1) {
    const auto at = static_cast<std::size_t>(15 - bit / 8);
    const auto mask = static_cast<std::uint8_t>(1u << (bit % 8));
    if ((value & 1u) != 0) bytes[at] = static_cast<std::uint8_t>(bytes[at] | mask);
  }
}

void close(Register& bytes) {
  const std::uint8_t crc = crc7(std::span<const std::uint8_t>(bytes).first(15));
  bytes[15] = static_cast<std::uint8_t>(crc << 1 | 1);
}

constexpr int kReadBlock_log2 = 9;
constexpr int kStandard_multiplier = 7;  // C_SIZE_MULT: 2^(7 + 2) blocks in a unit

void set_capacity(Register& r, bool high_capacity, std::int64_t size_bytes) {
  const std::int64_t unit = high_capacity ? kUnit_high_bytes : kUnit_standard_bytes;
  WHIRL_CHECK(size_bytes > 0 && size_bytes % unit == 0, size_bytes, unit);
  WHIRL_CHECK(high_capacity || size_bytes <= kMost_standard_bytes, size_bytes);
  const auto c_size = static_cast<std::uint32_t>(size_bytes / unit - 1);
  if (high_capacity) return set_bits(r, 69, 48, c_size);
  set_bits(r, 73, 62, c_size);
  set_bits(r, 49, 47, kStandard_multiplier);
}

}  // namespace

Register csd(bool high_capacity, std::int64_t size_bytes) {
  Register r{};
  set_bits(r, 127, 126, high_capacity ? 1 : 0);
  set_bits(r, 119, 112, high_capacity ? 0x0E : 0x26);  // TAAC: 1 ms, 1.5 ms
  set_bits(r, 103, 96, 0x32);                          // 25 MHz
  set_bits(r, 95, 84, high_capacity ? 0x5B5 : 0x1B5);  // without the switch class
  set_bits(r, 83, 80, kReadBlock_log2);
  set_capacity(r, high_capacity, size_bytes);
  set_bits(r, 46, 46, 1);     // single blocks can be erased
  set_bits(r, 45, 39, 0x7F);  // SECTOR_SIZE
  set_bits(r, 28, 26, 2);     // R2W_FACTOR
  set_bits(r, 25, 22, kReadBlock_log2);
  close(r);
  return r;
}

Register cid(const Identity& identity) {
  Register r{};
  set_bits(r, 127, 120, identity.manufacturer);
  for (std::size_t i = 0; i < 2; ++i) r[1 + i] = static_cast<std::uint8_t>(identity.application[i]);
  for (std::size_t i = 0; i < 5; ++i) r[3 + i] = static_cast<std::uint8_t>(identity.product[i]);
  set_bits(r, 63, 56, identity.revision_bcd);
  set_bits(r, 55, 24, identity.serial);
  set_bits(r, 19, 12, static_cast<std::uint32_t>(identity.year - 2000));
  set_bits(r, 11, 8, static_cast<std::uint32_t>(identity.month));
  close(r);
  return r;
}

}  // namespace whirl::io::sd

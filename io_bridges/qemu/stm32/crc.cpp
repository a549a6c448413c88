#include "io_bridges/qemu/stm32/crc.hpp"

#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

namespace {

enum : std::uint32_t { DR = 0x00, IDR = 0x04, CR = 0x08 };

std::uint32_t feed(std::uint32_t crc, std::uint32_t word) {
  crc ^= word;
  for (int i = 0; i < 32; ++i) crc = (crc << 1) ^ ((crc & 0x80000000u) != 0 ? 0x04C11DB7u : 0);
  return crc;
}

}  // namespace

void Crc::reset() {
  crc_ = 0xFFFFFFFF;
  independent_ = 0;
}

std::uint32_t Crc::read(std::uint32_t offset, unsigned size) {
  const std::uint32_t word = (offset & ~3u) == DR ? crc_ : (offset & ~3u) == IDR ? independent_ : 0;
  return part_of_word(word, offset, size);
}

void Crc::write(std::uint32_t offset, std::uint32_t value, unsigned /*size*/) {
  if (offset == DR) crc_ = feed(crc_, value);
  if (offset == IDR) independent_ = value & 0xFF;
  if (offset == CR && (value & 1) != 0) crc_ = 0xFFFFFFFF;
}

}  // namespace whirl::stm32

#include "io_bridges/devices/core/register_file.hpp"

namespace whirl::core {

void RegisterFile::reset() {
  for (std::size_t i = 0; i < kRegisters; ++i) bytes_[i] = map_[i].reset;
}

std::uint8_t RegisterFile::read(std::uint8_t address, Witness& witness, Nanoseconds now) const {
  if (address < kRegisters && map_[address].access != Access::reserved) return bytes_[address];
  witness.odd(Oddity::read_reserved, address, now);
  return 0;
}

bool RegisterFile::write(std::uint8_t address, std::uint8_t value, Witness& witness,
                         Nanoseconds now) {
  const Access access = address < kRegisters ? map_[address].access : Access::reserved;
  if (access == Access::reserved || access == Access::read_only) {
    const bool reserved = access == Access::reserved;
    witness.odd(reserved ? Oddity::write_reserved : Oddity::write_read_only, address, now);
    return false;
  }
  const RegisterSpec& spec = map_[address];
  if (spec.depth == Depth::stored_only && value != spec.reset) {
    witness.odd(Oddity::stored_only, address, now);
  }
  if (access != Access::write_only) bytes_[address] = value;
  return true;
}

}  // namespace whirl::core

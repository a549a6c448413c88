#include "io_bridges/qemu/stm32/probe_stub.hpp"

#include <cstdio>

#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

ProbeStub::ProbeStub(const Chip& chip, std::string name, std::uint32_t base,
                     std::initializer_list<StubRegister> registers)
    : chip_(chip), name_(std::move(name)), base_(base) {
  for (const StubRegister& shape : registers) cells_[shape.offset] = {shape, shape.reset_value};
}

void ProbeStub::reset() {
  for (auto& [offset, cell] : cells_) cell.value = cell.shape.reset_value;
}

void ProbeStub::report(std::uint32_t offset) {
  if (reported_ || !chip_.finding) return;
  reported_ = true;
  char text[64];
  std::snprintf(text, sizeof text, "not modelled: touched first at 0x%08X", base_ + offset);
  chip_.finding({chip_.events.now(), name_, text});
}

std::uint32_t ProbeStub::read(std::uint32_t offset, unsigned size) {
  const std::uint32_t at = offset & ~3u;
  report(at);
  const auto found = cells_.find(at);
  return found == cells_.end() ? 0 : part_of_word(found->second.value, offset, size);
}

void ProbeStub::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  const std::uint32_t at = offset & ~3u;
  report(at);
  const auto found = cells_.find(at);
  if (found == cells_.end()) return;
  Cell& cell = found->second;
  const std::uint32_t word = on_all_lanes(value, size) & ~cell.shape.self_clearing;
  cell.value = (cell.value & ~cell.shape.writable) | (word & cell.shape.writable);
}

}  // namespace whirl::stm32

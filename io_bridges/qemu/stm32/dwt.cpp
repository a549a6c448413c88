#include "io_bridges/qemu/stm32/dwt.hpp"

#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

namespace {

enum : std::uint32_t { CTRL = 0x00, CYCCNT = 0x04, DEMCR = 0x0C };
constexpr std::uint32_t kTrcena = 1u << 24;

}  // namespace

Dwt::Dwt(const Chip& chip) : chip_(chip) {
  const auto follow = [this] {
    sync();
    grid_.set_frequency(chip_.clocks.hclk_Hz(), chip_.events.now());
  };
  chip_.clocks.on_change(follow);
  follow();
}

void Dwt::sync() {
  const std::int64_t now = grid_.ticks(chip_.events.now());
  if (counting()) cycles_ += static_cast<std::uint32_t>(now - synced_);
  synced_ = now;
}

void Dwt::reset() {
  sync();
  ctrl_ = 0x40000000;
  cycles_ = 0;
}

void Dwt::set_trace_enabled(bool enabled) {
  sync();
  trace_enabled_ = enabled;
}

std::uint32_t Dwt::read(std::uint32_t offset, unsigned size) {
  sync();
  const std::uint32_t at = offset & ~3u;
  return part_of_word(at == CTRL ? ctrl_ : at == CYCCNT ? cycles_ : 0, offset, size);
}

void Dwt::write(std::uint32_t offset, std::uint32_t value, unsigned /*size*/) {
  sync();
  if (offset == CTRL) ctrl_ = 0x40000000 | (value & 0x007F1FFF);
  if (offset == CYCCNT) cycles_ = value;
}

std::uint32_t DebugCore::read(std::uint32_t offset, unsigned size) {
  return part_of_word((offset & ~3u) == DEMCR ? demcr_ : 0, offset, size);
}

void DebugCore::write(std::uint32_t offset, std::uint32_t value, unsigned /*size*/) {
  if ((offset & ~3u) != DEMCR) return;
  demcr_ = value & 0x010F07F1;
  dwt_.set_trace_enabled((demcr_ & kTrcena) != 0);
}

void DebugCore::reset() {
  demcr_ = 0;
  dwt_.set_trace_enabled(false);
}

}  // namespace whirl::stm32

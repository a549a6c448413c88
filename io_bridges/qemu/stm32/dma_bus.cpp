#include "io_bridges/qemu/stm32/dma_bus.hpp"

namespace whirl::stm32 {

void DmaBus::map(const std::vector<Region>& regions) {
  for (const Region& region : regions) {
    for (std::uint32_t at = region.base; at < region.base + region.size; at += 1024) {
      const std::uint32_t page = (at - kBase) >> 10;
      if (page < kPages) pages_[page] = region;
    }
  }
  clocks_.on_change([this] { clocks_changed(); });
  clocks_changed();
}

void DmaBus::clocks_changed() {
  const double hclk_Hz = clocks_.hclk_Hz();
  cycle_ns_ = hclk_Hz > 0.0 ? 1e9 / hclk_Hz : 0.0;
  bridge_ns_[0] = 2e9 / clocks_.pclk1_Hz();
  bridge_ns_[1] = 2e9 / clocks_.pclk2_Hz();
}

Region* DmaBus::find(std::uint32_t address) {
  const std::uint32_t page = (address - kBase) >> 10;
  return page < kPages && pages_[page].block != nullptr ? &pages_[page] : nullptr;
}

void DmaBus::count(std::uint32_t address) {
  constexpr std::uint32_t kApb2 = kBase + 0x10000, kEnd_of_apb = kBase + 0x18000;
  if (cycle_ns_ <= 0.0) return;  // no clock yet
  transfers_ns_ += cycle_ns_;
  if (address < kBase || address >= kEnd_of_apb) return;
  transfers_ns_ += bridge_ns_[address < kApb2 ? 0 : 1];
}

bool DmaBus::read(std::uint32_t address, unsigned size, std::uint32_t& value) {
  count(address);
  if (Region* region = find(address)) {
    value = region->block->read(address - region->base, size);
    return true;
  }
  return reachable(address) && memory_.read(address, size, value);
}

bool DmaBus::write(std::uint32_t address, unsigned size, std::uint32_t value) {
  count(address);
  if (Region* region = find(address)) {
    region->block->write(address - region->base, value, size);
    return true;
  }
  return reachable(address) && memory_.write(address, size, value);
}

}  // namespace whirl::stm32

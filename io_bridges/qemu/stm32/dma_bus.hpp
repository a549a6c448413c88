// What DMA reaches: the register blocks of the part by address, and beyond them the memories.
#pragma once
#include <array>
#include <vector>

#include "io_bridges/qemu/stm32/chip_model.hpp"

namespace whirl::stm32 {

class DmaBus final : public SystemBus {
 public:
  explicit DmaBus(SystemBus& memory) : memory_(memory) {}

  // Blocks between 0x40000000 and 0x40080000, found by their 1 KiB page.
  void map(const std::vector<Region>& regions);
  // An address range that this master does not reach (CCM).
  void bar(std::uint32_t base, std::uint32_t size) { barred_ = {base, size, nullptr}; }

  bool read(std::uint32_t address, unsigned size, std::uint32_t& value) override;
  bool write(std::uint32_t address, unsigned size, std::uint32_t value) override;

 private:
  static constexpr std::uint32_t kBase = 0x40000000, kPages = 512;
  Region* find(std::uint32_t address);
  bool reachable(std::uint32_t address) const { return address - barred_.base >= barred_.size; }

  SystemBus& memory_;
  std::array<Region, kPages> pages_{};
  Region barred_;
};

}  // namespace whirl::stm32

// What DMA reaches: the register blocks of the part by address, and beyond them the memories.
//
//   Core      does not wait for DMA here. On the part an access of the core to the same memory or bridge
//             waits for at most the one transfer under way (RM0090 2.1, RM0008 3.1: round robin); so the
//             transfers' time, a cycle of HCLK each and two PCLK more through a bridge, is a bound on
//             all that it may have waited
#pragma once
#include <array>
#include <vector>

#include "io_bridges/qemu/stm32/chip_model.hpp"

namespace whirl::stm32 {

class DmaBus final : public SystemBus {
 public:
  DmaBus(SystemBus& memory, Clocks& clocks) : memory_(memory), clocks_(clocks) {}

  // Once. Blocks between 0x40000000 and 0x40080000, found by their 1 KiB page.
  void map(const std::vector<Region>& regions);
  // An address range that this master does not reach (CCM).
  void bar(std::uint32_t base, std::uint32_t size) { barred_ = {base, size, nullptr}; }

  double core_waits_at_most_ns() const { return transfers_ns_; }  // since power-on

  bool read(std::uint32_t address, unsigned size, std::uint32_t& value) override;
  bool write(std::uint32_t address, unsigned size, std::uint32_t value) override;

 private:
  static constexpr std::uint32_t kBase = 0x40000000, kPages = 512;
  Region* find(std::uint32_t address);
  bool reachable(std::uint32_t address) const { return address - barred_.base >= barred_.size; }

  void count(std::uint32_t address);
  void clocks_changed();

  SystemBus& memory_;
  Clocks& clocks_;
  double cycle_ns_ = 0.0, bridge_ns_[2] = {};  // of HCLK; two PCLK of APB1, APB2
  double transfers_ns_ = 0.0;
  std::array<Region, kPages> pages_{};
  Region barred_;
};

}  // namespace whirl::stm32

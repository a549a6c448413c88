// A chip of nothing but time, clocks and lines, for tests of single blocks.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "io_bridges/qemu/stm32/peripheral.hpp"

namespace whirl::stm32::test {

class BareClocks : public Clocks {
 public:
  double hclk = 168e6, pclk1 = 42e6, pclk2 = 84e6, timclk1 = 84e6, timclk2 = 168e6, lsi = 32e3,
         lse = 32768, hse = 24e6;
  double hclk_Hz() const override { return hclk; }
  double pclk1_Hz() const override { return pclk1; }
  double pclk2_Hz() const override { return pclk2; }
  double timclk1_Hz() const override { return timclk1; }
  double timclk2_Hz() const override { return timclk2; }
  double lsi_Hz() const override { return lsi; }
  double lse_Hz() const override { return lse; }
  double hse_Hz() const override { return hse; }
  void on_change(std::function<void()> changed) override { changed_.push_back(std::move(changed)); }
  void change() {
    for (const auto& changed : changed_) changed();
  }

 private:
  std::vector<std::function<void()>> changed_;
};

class BareInterrupts : public InterruptLines {
 public:
  void set(int irq, bool level) override {
    if (level && !lines[irq]) ++rises[irq];
    lines[irq] = level;
  }
  std::map<int, bool> lines;
  std::map<int, int> rises;
};

class NoBus : public SystemBus {
 public:
  bool read(std::uint32_t, unsigned, std::uint32_t&) override { return false; }
  bool write(std::uint32_t, unsigned, std::uint32_t) override { return false; }
};

struct BareChip {
  io::EventQueue events;
  BareInterrupts interrupts;
  NoBus bus;
  BareClocks clocks;
  std::vector<io::Finding> findings;

  Chip chip() {
    return {events, interrupts, bus, clocks,
            [this](const io::Finding& finding) { findings.push_back(finding); }};
  }
  void run_to(Nanoseconds t) { events.run_until(t); }
};

inline std::uint32_t get(Peripheral& block, std::uint32_t offset) {
  return block.read(offset, 4);
}
inline void put(Peripheral& block, std::uint32_t offset, std::uint32_t value) {
  block.write(offset, value, 4);
}

}  // namespace whirl::stm32::test

// What stands in front of a block: its clock. Off (or held in reset), the block reads 0, ignores
// writes and the fact is reported once.
#pragma once
#include "io_bridges/qemu/stm32/peripheral.hpp"

namespace whirl::stm32 {

class ClockGate final : public Peripheral {
 public:
  // `enable`, `reset_line`: RCC registers; null: always clocked, no reset bit.
  struct Control {
    const std::uint32_t* enable = nullptr;
    std::uint32_t enable_mask = 0;
    const std::uint32_t* reset_line = nullptr;
    std::uint32_t reset_mask = 0;
  };

  ClockGate(Peripheral& block, Control control, const Chip& chip)
      : block_(block), control_(control), events_(chip.events), finding_(chip.finding) {}

  const char* name() const override { return block_.name(); }
  std::uint32_t read(std::uint32_t offset, unsigned size) override {
    return open() ? block_.read(offset, size) : 0;
  }
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override {
    if (open()) block_.write(offset, value, size);
  }
  void reset() override { block_.reset(); }

 private:
  bool open() {
    const bool clocked =
        control_.enable == nullptr || (*control_.enable & control_.enable_mask) != 0;
    const bool in_reset =
        control_.reset_line != nullptr && (*control_.reset_line & control_.reset_mask) != 0;
    if (clocked && !in_reset) return true;
    report(clocked);
    return false;
  }
  void report(bool clocked) {
    if (reported_ || !finding_) return;
    reported_ = true;
    finding_({events_.now(), block_.name(),
              clocked ? "accessed while RCC holds it in reset" : "accessed with its clock off"});
  }

  Peripheral& block_;
  Control control_;
  io::EventQueue& events_;
  io::FindingSink finding_;
  bool reported_ = false;
};

}  // namespace whirl::stm32

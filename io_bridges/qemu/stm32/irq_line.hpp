// Interrupt lines that several blocks share (TIM1_BRK_TIM9, ADC, TIM6_DAC).
//
//   IrqLine         one source; tells its chip each change of its level, once
//   OredInterrupts  stands in front of the NVIC and holds a line while any of its sources does
#pragma once
#include <map>

#include "io_bridges/qemu/stm32/peripheral.hpp"

namespace whirl::stm32 {

class IrqLine {
 public:
  IrqLine(InterruptLines& lines, int irq) : lines_(&lines), irq_(irq) {}
  void set(bool level) {
    if (level == level_ || irq_ < 0) return;
    level_ = level;
    lines_->set(irq_, level);
  }
  bool level() const { return level_; }

 private:
  InterruptLines* lines_;
  int irq_;  // below 0: not connected
  bool level_ = false;
};

// Pre: every source reports changes only and starts low (IrqLine does).
class OredInterrupts : public InterruptLines {
 public:
  explicit OredInterrupts(InterruptLines& nvic) : nvic_(nvic) {}
  void set(int irq, bool level) override {
    int& holders = holders_[irq];
    const bool was = holders > 0;
    holders += level ? 1 : -1;
    if ((holders > 0) != was) nvic_.set(irq, holders > 0);
  }

 private:
  InterruptLines& nvic_;
  std::map<int, int> holders_;
};

}  // namespace whirl::stm32

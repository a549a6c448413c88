// PWR of the STM32F405 (F103: without VOS, FPDS, BRE): backup write access, voltage detector.
//
//   Source    RM0090 chapter 5.4
//   PVDO      1 while VDD is below the chosen threshold; also EXTI line 16
//   Left out  Stop and Standby: the plug-in reports a WFI with SLEEPDEEP
#pragma once
#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

class Pwr final : public WordBlock {
 public:
  explicit Pwr(bool f4) : WordBlock("PWR"), f4_(f4) { reset(); }

  bool backup_writable() const { return (cr_ & 0x100) != 0; }
  void set_vdd(double volts);
  void on_pvd(std::function<void(bool below)> pvd) { pvd_ = std::move(pvd); }

  void reset() override;

 private:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  void detect();

  bool f4_;
  double vdd_V_ = 3.3;
  bool below_ = false;
  std::function<void(bool)> pvd_;
  std::uint32_t cr_ = 0, csr_ = 0;
};

}  // namespace whirl::stm32

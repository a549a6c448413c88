// RCC of the STM32F103: PLL, prescalers, ADC clock. See rcc.hpp.
//
//   Source    RM0008 7.3
//   Findings  SYSCLK, PCLK1 or PCLK2 above 72, 36, 72 MHz: once each
#pragma once
#include "io_bridges/qemu/stm32/rcc.hpp"

namespace whirl::stm32 {

class RccF1 final : public Rcc {
 public:
  explicit RccF1(const RccSetup& setup);
  double adcclk_Hz() const;

 private:
  void set_reset_values() override;
  ClockTree clock_tree() const override;
  bool pll_from_hse() const override;
  double rtc_from_hse_Hz() const override;
  bool pll_can_lock() override;
  void write_other(std::uint32_t offset, std::uint32_t value) override;
};

}  // namespace whirl::stm32

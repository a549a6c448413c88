// RCC of the STM32F405: PLL and prescalers. See rcc.hpp.
//
//   Source    RM0090 7.3
//   Findings  PLL input outside 1..2 MHz, VCO outside 100..432 MHz, SYSCLK, PCLK1 or PCLK2 above
//             168, 42, 84 MHz: once each
#pragma once
#include "io_bridges/qemu/stm32/rcc.hpp"

namespace whirl::stm32 {

class RccF4 final : public Rcc {
 public:
  explicit RccF4(const RccSetup& setup);
  double pll48_Hz() const;  // PLLQ output: RNG, SDIO, USB

 private:
  void set_reset_values() override;
  ClockTree clock_tree() const override;
  bool pll_from_hse() const override;
  double rtc_from_hse_Hz() const override;
  bool pll_can_lock() override;
  void write_other(std::uint32_t offset, std::uint32_t value) override;
  double pll_input_Hz() const;
  double vco_Hz() const;
};

}  // namespace whirl::stm32

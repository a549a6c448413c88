#include "io_bridges/qemu/stm32/rcc_f4.hpp"

namespace whirl::stm32 {
namespace {

enum Offset : std::uint32_t {
  CR = 0x00,
  PLLCFGR = 0x04,
  CFGR = 0x08,
  AHB1ENR = 0x30,
  AHB1LPENR = 0x50,
  AHB2LPENR = 0x54,
  AHB3LPENR = 0x58,
  APB1LPENR = 0x60,
  APB2LPENR = 0x64,
  PLLI2SCFGR = 0x84,
};
constexpr std::uint32_t PLLSRC = 1u << 22, PLLI2SON = 1u << 26, PLLRDY = 1u << 25;
constexpr double kHsi_Hz = 16e6;

constexpr RccLayout kLayout{.cfgr = CFGR,
                            .cir = 0x0C,
                            .bdcr = 0x70,
                            .csr = 0x74,
                            .first_reset = 0x10,
                            .last_reset = 0x24,
                            .cr_writable = 0x050D00F9,
                            .power_on_causes = 0x0E000000,  // POR, BOR, NRST
                            .hsi_Hz = kHsi_Hz,
                            .lsi_Hz = 32e3,
                            .max_sysclk_Hz = 168e6,
                            .max_pclk1_Hz = 42e6,
                            .max_pclk2_Hz = 84e6};

}  // namespace

RccF4::RccF4(const RccSetup& setup) : Rcc(setup, kLayout) {
  system_reset(ResetCause::power_on);
}

void RccF4::set_reset_values() {
  word(PLLCFGR) = 0x24003010;
  word(AHB1ENR) = 0x00100000;
  word(AHB1LPENR) = 0x7E6791FF;
  word(AHB2LPENR) = 0x000000F1;
  word(AHB3LPENR) = 0x00000001;
  word(APB1LPENR) = 0x36FEC9FF;
  word(APB2LPENR) = 0x00075F33;
  word(PLLI2SCFGR) = 0x20003000;
}

void RccF4::write_other(std::uint32_t offset, std::uint32_t value) {
  if (offset == PLLCFGR) {
    if (!pll_on()) word(PLLCFGR) = value & 0x0F437FFF;
  } else if (offset == PLLI2SCFGR) {
    if ((word(CR) & PLLI2SON) == 0) word(PLLI2SCFGR) = value & 0x70007FC0;
  } else {
    word(offset) = value;  // enables, low-power enables, SSCGR: stored
  }
}

bool RccF4::pll_from_hse() const {
  return (word(PLLCFGR) & PLLSRC) != 0;
}

double RccF4::pll_input_Hz() const {
  const std::uint32_t m = word(PLLCFGR) & 0x3F;
  return m < 2 ? 0.0 : (pll_from_hse() ? hse_Hz_ : kHsi_Hz) / m;
}

double RccF4::vco_Hz() const {
  return pll_input_Hz() * ((word(PLLCFGR) >> 6) & 0x1FF);
}

double RccF4::pll48_Hz() const {
  const std::uint32_t q = (word(PLLCFGR) >> 24) & 0xF;
  return (word(CR) & PLLRDY) != 0 && q >= 2 ? vco_Hz() * (1.0 + error_of(pll_from_hse())) / q : 0.0;
}

ClockTree RccF4::clock_tree() const {
  const std::uint32_t cfgr = word(CFGR);
  const std::uint32_t p = 2 * (((word(PLLCFGR) >> 16) & 3) + 1);
  ClockTree tree;
  tree.sysclk_Hz = sws() == hsi ? kHsi_Hz : sws() == hse ? hse_Hz_ : vco_Hz() / p;
  tree.ahb = ahb_divisor((cfgr >> 4) & 0xF);
  tree.apb1 = apb_divisor((cfgr >> 10) & 7);
  tree.apb2 = apb_divisor((cfgr >> 13) & 7);
  return tree;
}

double RccF4::rtc_from_hse_Hz() const {
  const std::uint32_t divisor = (word(CFGR) >> 16) & 0x1F;
  return divisor >= 2 ? hse_Hz_ / divisor : 0.0;
}

bool RccF4::pll_can_lock() {
  if (pll_input_Hz() == 0.0) {
    report_once(8, "PLL without a usable input (PLLM below 2, or no crystal): it will not lock");
    return false;
  }
  if (pll_input_Hz() < 0.95e6 || pll_input_Hz() > 2.1e6) {
    report_once(16, "PLL input outside 1 to 2 MHz");
  }
  if (vco_Hz() < 100e6 || vco_Hz() > 432e6) report_once(32, "PLL VCO outside 100 to 432 MHz");
  return true;
}

}  // namespace whirl::stm32

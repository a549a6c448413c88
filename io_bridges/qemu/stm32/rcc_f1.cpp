#include "io_bridges/qemu/stm32/rcc_f1.hpp"

#include <algorithm>

namespace whirl::stm32 {
namespace {

enum Offset : std::uint32_t { CFGR = 0x04, AHBENR = 0x14 };
constexpr std::uint32_t PLLSRC = 1u << 16, PLLXTPRE = 1u << 17;
constexpr double kHsi_Hz = 8e6;

constexpr RccLayout kLayout{.cfgr = CFGR,
                            .cir = 0x08,
                            .bdcr = 0x20,
                            .csr = 0x24,
                            .first_reset = 0x0C,
                            .last_reset = 0x10,
                            .cr_writable = 0x010D00F9,
                            .power_on_causes = 0x0C000000,  // POR, NRST
                            .hsi_Hz = kHsi_Hz,
                            .lsi_Hz = 40e3,
                            .max_sysclk_Hz = 72e6,
                            .max_pclk1_Hz = 36e6,
                            .max_pclk2_Hz = 72e6};

}  // namespace

RccF1::RccF1(const RccSetup& setup) : Rcc(setup, kLayout) {
  system_reset(ResetCause::power_on);
}

void RccF1::set_reset_values() {
  word(AHBENR) = 0x14;
}

void RccF1::write_other(std::uint32_t offset, std::uint32_t value) {
  word(offset) = value;
}

bool RccF1::pll_from_hse() const {
  return (word(CFGR) & PLLSRC) != 0;
}

bool RccF1::pll_can_lock() {
  if (!pll_from_hse() || hse_Hz_ > 0.0) return true;
  report_once(8, "PLL runs from HSE, but no crystal is fitted");
  return false;
}

ClockTree RccF1::clock_tree() const {
  const std::uint32_t cfgr = word(CFGR);
  double input_Hz = kHsi_Hz / 2;
  if (pll_from_hse()) input_Hz = (cfgr & PLLXTPRE) != 0 ? hse_Hz_ / 2 : hse_Hz_;
  const std::uint32_t mul = std::min((cfgr >> 18) & 0xF, 14u) + 2;
  ClockTree tree;
  tree.sysclk_Hz = sws() == hsi ? kHsi_Hz : sws() == hse ? hse_Hz_ : input_Hz * mul;
  tree.ahb = ahb_divisor((cfgr >> 4) & 0xF);
  tree.apb1 = apb_divisor((cfgr >> 8) & 7);
  tree.apb2 = apb_divisor((cfgr >> 11) & 7);
  return tree;
}

double RccF1::adcclk_Hz() const {
  return pclk2_Hz() / (2 * (((word(CFGR) >> 14) & 3) + 1));
}

double RccF1::rtc_from_hse_Hz() const {
  return hse_Hz_ / 128;
}

}  // namespace whirl::stm32

#include "firmware/hal/clock.hpp"

#include "firmware/hal/registers.hpp"

namespace fw::hal {
namespace {

using namespace hw;

#ifndef FW_CRYSTAL_MHZ
#define FW_CRYSTAL_MHZ 24
#endif

// The crystal / M = 2 MHz into the PLL, x 168 = 336 MHz, / 2 = 168 MHz; / 7 = 48 MHz for USB.
constexpr std::uint32_t kPllM = FW_CRYSTAL_MHZ / 2, kPllN = 168, kPllP_div2 = 0, kPllQ = 7;
constexpr int kStartupPolls = 200'000;  // far beyond the crystal's 2 ms at 16 MHz

template <typename Register>
bool wait_for(std::uint32_t mask, std::uint32_t value) {
  for (int i = 0; i < kStartupPolls; ++i) {
    if ((Register::read() & mask) == value) return true;
  }
  return false;
}

}  // namespace

Status start_clocks() {
  RCC::APB1ENR::set(RCC::PWREN);
  PWR::CR::set(PWR::VOS);
  RCC::CR::set(RCC::HSEON);
  if (!wait_for<RCC::CR>(RCC::HSERDY, RCC::HSERDY)) return Status::no_answer;
  RCC::PLLCFGR::write(kPllM | kPllN << 6 | kPllP_div2 << 16 | RCC::PLLSRC_HSE | kPllQ << 24);
  RCC::CR::set(RCC::PLLON);
  if (!wait_for<RCC::CR>(RCC::PLLRDY, RCC::PLLRDY)) return Status::no_answer;
  FLASH::ACR::write(FLASH::LATENCY_5WS | FLASH::PRFTEN | FLASH::ICEN | FLASH::DCEN);
  if ((FLASH::ACR::read() & 7u) != FLASH::LATENCY_5WS) return Status::config_lost;
  RCC::CFGR::write(RCC::PPRE1_DIV4 | RCC::PPRE2_DIV2);
  RCC::CFGR::set(RCC::SW_PLL);
  return wait_for<RCC::CFGR>(RCC::SWS_Msk, RCC::SWS_PLL) ? Status::ok : Status::no_answer;
}

ResetCause take_reset_cause() {
  const std::uint32_t flags = RCC::CSR::read();
  RCC::CSR::set(RCC::RMVF);
  if ((flags & (RCC::WDGRSTF | RCC::WWDGRSTF)) != 0) return ResetCause::watchdog;
  if ((flags & RCC::LPWRRSTF) != 0) return ResetCause::low_power;
  if ((flags & RCC::SFTRSTF) != 0) return ResetCause::software;
  if ((flags & (RCC::PORRSTF | RCC::BORRSTF)) != 0) return ResetCause::power;
  return ResetCause::pin;
}

}  // namespace fw::hal

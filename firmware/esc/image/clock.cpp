#include "firmware/esc/image/clock.hpp"

#include "firmware/esc/image/registers.hpp"

namespace fw::esc {

using namespace f103;

void start_clock() {
  FLASH::ACR::write(FLASH::LATENCY_2WS | FLASH::PRFTBE);
  RCC::CR::set(RCC::HSEON);
  while (!RCC::CR::has(RCC::HSERDY)) {
  }
  RCC::CFGR::write(RCC::PLLMUL9 | RCC::PLLSRC_HSE | RCC::PPRE1_DIV2 | RCC::ADCPRE_DIV6);
  RCC::CR::set(RCC::PLLON);
  while (!RCC::CR::has(RCC::PLLRDY)) {
  }
  RCC::CFGR::set(RCC::SW_PLL);
  while ((RCC::CFGR::read() & RCC::SWS_Msk) != RCC::SWS_PLL) {
  }
  RCC::APB2ENR::set(RCC::AFIOEN | RCC::IOPAEN | RCC::IOPBEN);
  AFIO::MAPR::write(AFIO::SWJ_JTAG_OFF);
}

void start_watchdog() {
  constexpr std::uint32_t kDivideBy4 = 0, kReload = 2000;  // 2000 / 10 kHz
  IWDG::KR::write(IWDG::START);
  IWDG::KR::write(IWDG::UNLOCK);
  IWDG::PR::write(kDivideBy4);
  IWDG::RLR::write(kReload);
  IWDG::KR::write(IWDG::RELOAD);
}

}  // namespace fw::esc

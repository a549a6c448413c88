#include <bit>

#include "firmware/hal/pins.hpp"
#include "firmware/hal/registers.hpp"
#include "firmware/timing/part.hpp"

namespace fw::timing {
namespace {

using namespace hw;

constexpr std::uint32_t kHsi_Hz = 16'000'000, kBaud = 115'200, kAfUsart2 = 7;
constexpr std::uint32_t kTxe = bit(7), kTc = bit(6);         // USART_SR
constexpr std::uint32_t kIcrst = bit(11), kDcrst = bit(12);  // FLASH_ACR
constexpr int kPrescaler_cycles = 16;                        // until a new divider acts, RCC_CFGR
constexpr std::uint32_t kPpre1_msk = 7u << 10, kPpre1_div4 = 5u << 10;

}  // namespace

constinit const std::string_view kPartName = "stm32f405";
constinit const std::uint32_t kMost_wait_states = 5;
constinit const bool kHas_flash_cache = true;

std::uint16_t* not_executable() {
  constexpr std::uint32_t kCcm = 0x1000'0000;  // the stack is at its end
  return std::bit_cast<std::uint16_t*>(kCcm);
}

void start_part() {
  RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::CCMDATARAMEN);
  RCC::APB1ENR::set(RCC::USART2EN | RCC::TIM2EN);
  hal::RadioTx::alternate(kAfUsart2, false, hal::Pull::none);
  USART2::BRR::write((kHsi_Hz + kBaud / 2) / kBaud);
  USART2::CR1::write(USART2::UE | USART2::TE);
}

void send(std::string_view text) {
  for (const char c : text) {
    while (!USART2::SR::has(kTxe)) {
    }
    USART2::DR::write(static_cast<std::uint8_t>(c));
  }
  while (!USART2::SR::has(kTc)) {
  }
}

void set_flash(std::uint32_t wait_states, FlashAid aid) {
  FLASH::ACR::write(wait_states);
  FLASH::ACR::write(wait_states | kIcrst | kDcrst);  // only while they are off
  FLASH::ACR::write(wait_states);
  const bool prefetch = aid == FlashAid::prefetch || aid == FlashAid::all;
  const bool cache = aid == FlashAid::cache || aid == FlashAid::all;
  FLASH::ACR::write(wait_states | (prefetch ? FLASH::PRFTEN : 0) |
                    (cache ? FLASH::ICEN | FLASH::DCEN : 0));
}

void divide_apb1_by_4(bool on) {
  RCC::CFGR::replace(kPpre1_msk, on ? kPpre1_div4 : 0);
  for (int i = 0; i < kPrescaler_cycles; ++i) __asm volatile("nop");
}

}  // namespace fw::timing

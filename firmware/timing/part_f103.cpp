#include "firmware/esc/image/registers.hpp"
#include "firmware/timing/part.hpp"

// The start-up code names the lines of the motor controller; here they stay silent.
extern "C" {
void unexpected_interrupt();
#define FW_SILENT __attribute__((nothrow, alias("silent_line")))
__attribute__((used)) void silent_line() {
  unexpected_interrupt();
}
FW_SILENT void systick_handler();
FW_SILENT void adc1_2_handler();
FW_SILENT void can_tx_handler();
FW_SILENT void can_rx0_handler();
FW_SILENT void can_sce_handler();
FW_SILENT void tim2_handler();
FW_SILENT void i2c2_ev_handler();
FW_SILENT void i2c2_er_handler();
FW_SILENT void dma1_channel4_handler();
#undef FW_SILENT
}

namespace fw::timing {
namespace {

using namespace f103;

constexpr std::uint32_t kHsi_Hz = 8'000'000, kBaud = 115'200;
constexpr std::uint32_t kTxe = bit(7), kTc = bit(6);  // USART_SR
constexpr int kPrescaler_cycles = 16;                 // until a new divider acts, RCC_CFGR
constexpr std::uint32_t kPpre1_msk = 7u << 8, kPpre1_div4 = 5u << 8;
using Usart1Status = Reg32<USART1::base>;

}  // namespace

constinit const std::string_view kPartName = "stm32f103";
constinit const std::uint32_t kMost_wait_states = 2;
constinit const bool kHas_flash_cache = false;

std::uint16_t* not_executable() {
  return nullptr;
}

void start_part() {
  RCC::APB2ENR::set(RCC::IOPAEN | RCC::USART1EN);
  RCC::APB1ENR::set(RCC::TIM2EN);
  GPIOA::configure(9, kAlternate);
  USART1::BRR::write((kHsi_Hz + kBaud / 2) / kBaud);
  USART1::CR1::write(USART1::UE | USART1::TE);
}

void send(std::string_view text) {
  for (const char c : text) {
    while (!Usart1Status::has(kTxe)) {
    }
    USART1::DR::write(static_cast<std::uint8_t>(c));
  }
  while (!Usart1Status::has(kTc)) {
  }
}

void set_flash(std::uint32_t wait_states, FlashAid aid) {
  FLASH::ACR::write(wait_states | (aid == FlashAid::none ? 0 : FLASH::PRFTBE));
}

void divide_apb1_by_4(bool on) {
  RCC::CFGR::replace(kPpre1_msk, on ? kPpre1_div4 : 0);
  for (int i = 0; i < kPrescaler_cycles; ++i) __asm volatile("nop");
}

}  // namespace fw::timing

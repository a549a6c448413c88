#include "firmware/hal/receiver_uart.hpp"

#include "firmware/hal/clock.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/registers.hpp"

namespace fw::hal {
namespace {

using namespace hw;

constexpr std::uint32_t kAfUsart1 = 7, kSbusBaud = 100'000;

}  // namespace

void start_receiver_uart() {
  RCC::AHB1ENR::set(RCC::GPIOBEN);
  RCC::APB2ENR::set(RCC::USART1EN);
  ReceiverSbus::alternate(kAfUsart1, false, Pull::up);
  USART1::BRR::write(kPclk2_Hz / kSbusBaud);
  USART1::CR2::write(USART1::STOP_2);
  USART1::CR1::write(USART1::UE | USART1::M | USART1::PCE | USART1::RE | USART1::RXNEIE);
  Nvic<Irq::USART1_Global>::enable(kPriorityUart);
}

}  // namespace fw::hal

// The status before the byte: reading both clears the errors, and an overrun that left no byte.
extern "C" void usart1_handler() {
  using U = fw::hw::USART1;
  const bool error = (U::SR::read() & (U::PE | U::FE | U::NF | U::ORE)) != 0;
  fw::receiver_byte(static_cast<std::uint8_t>(U::DR::read()), error);
}

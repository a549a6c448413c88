// USART1 (PA9, PA10) at 3 Mbaud: the link to the host where there is no CAN.
#include "firmware/pod/host_uart.hpp"

#include "firmware/hal/clock.hpp"
#include "firmware/hal/uart_dma.hpp"
#include "firmware/pod/pod_pins.hpp"

namespace fw::hal {

using namespace hw;

struct HostUart {
  using Lock = PriorityLock<kPriorityUart>;  // an answer on SPI does not wait for a frame's copy
  using Block = USART1;
  using RxDma = Usart1RxDma;
  using TxDma = Usart1TxDma;
  using Tx = pod::HostTx;
  using Rx = pod::HostRx;
  static constexpr std::uint32_t kAf = 7, kDmaChannel = 4, kClock_Hz = kPclk2_Hz;
  static constexpr Irq kSent = Irq::DMA2_Stream7;
  static void start_clocks() {
    RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::DMA2EN);
    RCC::APB2ENR::set(RCC::USART1EN);
  }
};

template class UartLink<HostUart>;

}  // namespace fw::hal

namespace fw::pod {

constinit hal::UartLink<hal::HostUart> host_uart;

}  // namespace fw::pod

extern "C" void dma2_stream7_handler() {
  fw::pod::host_uart.piece_sent();
}

#include "firmware/hal/uart_link.hpp"

#include "firmware/hal/clock.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/uart_dma.hpp"

namespace fw::hal {

using namespace hw;

struct RadioUart {
  using Lock = InterruptLock;
  using Block = USART2;
  using RxDma = Usart2RxDma;
  using TxDma = Usart2TxDma;
  using Tx = RadioTx;
  using Rx = RadioRx;
  static constexpr std::uint32_t kAf = 7, kDmaChannel = 4, kClock_Hz = kPclk1_Hz;
  static constexpr Irq kSent = Irq::DMA1_Stream6;
  static void start_clocks() {
    RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::DMA1EN);
    RCC::APB1ENR::set(RCC::USART2EN);
  }
};

struct GpsUart : Usart6Port<InterruptLock, GpsTx, GpsRx> {};

constinit UartLink<RadioUart> radio;
constinit UartLink<GpsUart> gps_uart;

template class UartLink<RadioUart>;
template class UartLink<GpsUart>;

}  // namespace fw::hal

extern "C" void dma1_stream6_handler() {
  fw::hal::radio.piece_sent();
}

extern "C" void dma2_stream6_handler() {
  fw::hal::gps_uart.piece_sent();
}

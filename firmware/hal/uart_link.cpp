#include "firmware/hal/uart_link.hpp"

#include <algorithm>
#include <bit>

#include "firmware/hal/clock.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/registers.hpp"

namespace fw::hal {

using namespace hw;

constinit UartLink radio;

namespace {
constexpr std::uint32_t kAfUsart2 = 7, kDmaChannel = 4, kBaud = 57'600;
}

void UartLink::init() {
  RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::DMA1EN);
  RCC::APB1ENR::set(RCC::USART2EN);
  RadioTx::alternate(kAfUsart2, false, Pull::none);
  RadioRx::alternate(kAfUsart2, false, Pull::up);
  USART2::BRR::write((kPclk1_Hz + kBaud / 2) / kBaud);
  USART2::CR3::write(USART2::DMAR | USART2::DMAT);
  USART2::CR1::write(USART2::UE | USART2::TE | USART2::RE);
  Usart2RxDma::PAR::write(USART2::DR::address);
  Usart2RxDma::M0AR::write(std::bit_cast<std::uint32_t>(rx_.data()));
  Usart2RxDma::NDTR::write(kRxSize);
  Usart2RxDma::CR::write(Usart2RxDma::channel(kDmaChannel) | Usart2RxDma::MINC | Usart2RxDma::CIRC |
                         Usart2RxDma::EN);
  Usart2TxDma::PAR::write(USART2::DR::address);
  Nvic<Irq::DMA1_Stream6>::enable(kPriorityRadio);
}

std::size_t UartLink::read(std::span<std::uint8_t> out) {
  const std::size_t end = (kRxSize - Usart2RxDma::NDTR::read()) % kRxSize;
  std::size_t n = 0;
  while (rx_next_ != end && n < out.size()) {
    // Volatile, for the DMA writes behind the compiler's back.
    out[n++] = const_cast<const volatile std::uint8_t&>(rx_[rx_next_]);
    rx_next_ = (rx_next_ + 1) % kRxSize;
  }
  return n;
}

Status UartLink::send(std::span<const std::uint8_t> frame) {
  const InterruptLock lock;
  if (frame.size() > kTxSize - tx_count_) return Status::busy;
  for (const std::uint8_t byte : frame) tx_[(tx_head_ + tx_count_++) % kTxSize] = byte;
  if (tx_piece_ == 0) send_next_piece();
  return Status::ok;
}

void UartLink::piece_sent() {
  tx_head_ = (tx_head_ + tx_piece_) % kTxSize;
  tx_count_ -= tx_piece_;
  tx_piece_ = 0;
  if (tx_count_ > 0) send_next_piece();
}

void UartLink::send_next_piece() {
  tx_piece_ = std::min(tx_count_, kTxSize - tx_head_);
  Usart2TxDma::IFCR::write(Usart2TxDma::all_flags);
  Usart2TxDma::M0AR::write(std::bit_cast<std::uint32_t>(tx_.data() + tx_head_));
  Usart2TxDma::NDTR::write(tx_piece_);
  __asm volatile("dsb" ::: "memory");
  Usart2TxDma::CR::write(Usart2TxDma::channel(kDmaChannel) | Usart2TxDma::MINC |
                         Usart2TxDma::DIR_M2P | Usart2TxDma::TCIE | Usart2TxDma::EN);
}

}  // namespace fw::hal

extern "C" void dma1_stream6_handler() {
  fw::hw::Usart2TxDma::IFCR::write(fw::hw::Usart2TxDma::all_flags);
  fw::hal::radio.piece_sent();
}

// UartLink's bodies, for the files that say which blocks, pins and streams a UART has.
#pragma once
#include <algorithm>
#include <bit>

#include "firmware/hal/clock.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/registers.hpp"
#include "firmware/hal/uart_link.hpp"

namespace fw::hal {

// USART6 with DMA2, for a GPS or what plays one.
template <typename L, typename TxPin, typename RxPin>
struct Usart6Port {
  using Lock = L;
  using Block = hw::USART6;
  using RxDma = hw::Usart6RxDma;
  using TxDma = hw::Usart6TxDma;
  using Tx = TxPin;
  using Rx = RxPin;
  static constexpr std::uint32_t kAf = 8, kDmaChannel = 5, kClock_Hz = kPclk2_Hz;
  static constexpr hw::Irq kSent = hw::Irq::DMA2_Stream6;
  static void start_clocks() {
    hw::RCC::AHB1ENR::set(hw::RCC::GPIOCEN | hw::RCC::DMA2EN);
    hw::RCC::APB2ENR::set(hw::RCC::USART6EN);
  }
};

template <typename Port>
void UartLink<Port>::init(std::uint32_t baud) {
  using Block = typename Port::Block;
  using Dma = typename Port::RxDma;
  Port::start_clocks();
  Port::Tx::alternate(Port::kAf, false, Pull::none);
  Port::Rx::alternate(Port::kAf, false, Pull::up);
  set_baud(baud);
  Block::CR3::write(Block::DMAR | Block::DMAT);
  Block::CR1::write(Block::UE | Block::TE | Block::RE);
  Dma::PAR::write(Block::DR::address);
  Dma::M0AR::write(std::bit_cast<std::uint32_t>(rx_.data()));
  Dma::NDTR::write(kRxSize);
  Dma::CR::write(Dma::channel(Port::kDmaChannel) | Dma::MINC | Dma::CIRC | Dma::EN);
  Port::TxDma::PAR::write(Block::DR::address);
  hw::Nvic<Port::kSent>::enable(kPriorityUart);
}

template <typename Port>
void UartLink<Port>::set_baud(std::uint32_t baud) {
  Port::Block::BRR::write((Port::kClock_Hz + baud / 2) / baud);
}

template <typename Port>
std::size_t UartLink<Port>::read(std::span<std::uint8_t> out) {
  const std::size_t end = (kRxSize - Port::RxDma::NDTR::read()) % kRxSize;
  std::size_t n = 0;
  while (rx_next_ != end && n < out.size()) {
    // Volatile, for the DMA writes behind the compiler's back.
    out[n++] = const_cast<const volatile std::uint8_t&>(rx_[rx_next_]);
    rx_next_ = (rx_next_ + 1) % kRxSize;
  }
  return n;
}

template <typename Port>
Status UartLink<Port>::send(std::span<const std::uint8_t> frame) {
  const typename Port::Lock lock;
  if (frame.size() > kTxSize - tx_count_) return Status::busy;
  for (const std::uint8_t byte : frame) tx_[(tx_head_ + tx_count_++) % kTxSize] = byte;
  if (tx_piece_ == 0) send_next_piece();
  return Status::ok;
}

template <typename Port>
void UartLink<Port>::piece_sent() {
  Port::TxDma::IFCR::write(Port::TxDma::all_flags);
  tx_head_ = (tx_head_ + tx_piece_) % kTxSize;
  tx_count_ -= tx_piece_;
  tx_piece_ = 0;
  if (tx_count_ > 0) send_next_piece();
}

template <typename Port>
void UartLink<Port>::send_next_piece() {
  using Dma = typename Port::TxDma;
  tx_piece_ = std::min(tx_count_, kTxSize - tx_head_);
  Dma::IFCR::write(Dma::all_flags);
  Dma::M0AR::write(std::bit_cast<std::uint32_t>(tx_.data() + tx_head_));
  Dma::NDTR::write(tx_piece_);
  __asm volatile("dsb" ::: "memory");
  Dma::CR::write(Dma::channel(Port::kDmaChannel) | Dma::MINC | Dma::DIR_M2P | Dma::TCIE | Dma::EN);
}

}  // namespace fw::hal

// A UART, 8N1: reception into a ring by circular DMA, transmission from a ring by DMA, piece by piece.
//
//   UARTs    radio: USART2 (PA2, PA3), 57600 baud; gps_uart: USART6 (PC6, PC7)
//   Read     tasks call read() often enough that 256 bytes never wrap: 44 ms at 57600 baud
//   Baud     set_baud() acts at once, on what is still in the ring of transmission, too: a caller that
//            changes it waits until its bytes are out
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "firmware/status.hpp"

namespace fw::hal {

// Port: which block, pins and DMA streams (uart_link.cpp), and what keeps its interrupt out meanwhile.
template <typename Port>
class UartLink {
 public:
  void init(std::uint32_t baud);
  void set_baud(std::uint32_t baud);
  // Copies what has come in since the last call; at most out.size().
  std::size_t read(std::span<std::uint8_t> out);
  Status send(std::span<const std::uint8_t> frame);  // all of it, or busy: no room

  std::size_t waiting() const { return tx_count_; }  // not yet with the UART

  void piece_sent();  // from the DMA's interrupt

 private:
  void send_next_piece();

  static constexpr std::size_t kRxSize = 256, kTxSize = 512;
  std::array<std::uint8_t, kRxSize> rx_{};
  std::array<std::uint8_t, kTxSize> tx_{};
  std::size_t rx_next_ = 0;
  std::size_t tx_head_ = 0, tx_count_ = 0, tx_piece_ = 0;
};

struct RadioUart;
struct GpsUart;
extern UartLink<RadioUart> radio;
extern UartLink<GpsUart> gps_uart;

}  // namespace fw::hal

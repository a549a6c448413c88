// USART2 at 57600 8N1 for the radio: reception into a ring by circular DMA, transmission from a
// ring by DMA, piece by piece. Tasks call read() often enough that 256 bytes never wrap (44 ms).
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "firmware/status.hpp"

namespace fw::hal {

class UartLink {
 public:
  void init();
  // Copies what has come in since the last call; at most out.size().
  std::size_t read(std::span<std::uint8_t> out);
  Status send(std::span<const std::uint8_t> frame);  // all of it, or busy: no room

  void piece_sent();  // from the DMA's interrupt

 private:
  void send_next_piece();

  static constexpr std::size_t kRxSize = 256, kTxSize = 512;
  std::array<std::uint8_t, kRxSize> rx_{};
  std::array<std::uint8_t, kTxSize> tx_{};
  std::size_t rx_next_ = 0;
  std::size_t tx_head_ = 0, tx_count_ = 0, tx_piece_ = 0;
};

extern UartLink radio;

}  // namespace fw::hal

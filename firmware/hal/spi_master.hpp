// SPI1 by DMA, one transfer at a time: starts it and returns; the end comes as an interrupt.
//
//   Clock   slow 656 kHz (registers of the MPU6000), fast 10.5 MHz (its data); mode 3
//   Select  PB0, low from start() to the end of the transfer
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "firmware/status.hpp"

namespace fw::hal {

class SpiMaster {
 public:
  static constexpr std::size_t kMaxLength = 16;

  void init();
  Status start(std::span<const std::uint8_t> out, bool fast);  // busy: one is running
  std::span<const std::uint8_t> received() const { return {in_.data(), length_}; }

  void finish();  // from the DMA's interrupt

 private:
  std::array<std::uint8_t, kMaxLength> out_{}, in_{};
  std::size_t length_ = 0;
  volatile bool running_ = false;
};

extern SpiMaster spi1;

}  // namespace fw::hal

namespace fw {
void imu_transfer_done();  // supplied by the application; called from the DMA's interrupt
void imu_data_ready();     // the same, from the pin's
}  // namespace fw

// An SPI as master, by DMA, one exchange at a time: start() begins it and returns.
//
//   Buses   spi1 to the IMU: mode 3, 656 kHz (registers) or 10.5 MHz (data), the end comes as an
//           interrupt. spi3 to the SD card: mode 0, 328 kHz (start-up) or 21 MHz, the end is polled
//   Bytes   are exchanged in place: what came stands where stood what went. They are the bus's until
//           done(), in memory that DMA reaches (not the core-coupled one, where the stack is)
//   Select  by the caller, before and after
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "firmware/status.hpp"

namespace fw::hal {

// Bus: which block, pins, DMA streams and clocks (spi_master.cpp).
template <typename Bus>
class SpiMaster {
 public:
  void init();
  void select(bool on);                                    // chip select; true: low
  Status start(std::span<std::uint8_t> bytes, bool fast);  // busy: one is running
  bool done();
  void finish();  // from the interrupt at the end, of a bus that has one

 private:
  const std::uint8_t* memory_ = nullptr;  // where the streams exchange
  volatile bool running_ = false;
};

struct ImuBus;
struct CardBus;
extern SpiMaster<ImuBus> spi1;
extern SpiMaster<CardBus> spi3;

// The IMU's way to use its bus: select is low for one exchange, whose bytes are kept here.
class ImuLink {
 public:
  static constexpr std::size_t kMaxLength = 16;

  void init();
  Status start(std::span<const std::uint8_t> out, bool fast);  // busy: one is running
  std::span<const std::uint8_t> received() const { return {bytes_.data(), length_}; }

  void finish();  // from the DMA's interrupt

 private:
  std::array<std::uint8_t, kMaxLength> bytes_{};
  std::size_t length_ = 0;
  volatile bool running_ = false;
};

extern ImuLink imu_link;

}  // namespace fw::hal

namespace fw {
void imu_transfer_done();  // supplied by the application; called from the DMA's interrupt
void imu_data_ready();     // the same, from the pin's
}  // namespace fw

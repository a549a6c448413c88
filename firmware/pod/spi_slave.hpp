// SPI1 as a slave that answers like a part with registers: a command byte (bit 7: read, 6..0: where),
// then bytes, from there on.
//
//   Burst    the read that is expected next is prepared whole: DMA fills DR a byte ahead, so that it is
//            answered at any clock that the block takes
//   Others   the answer is looked up in the half period between the command's last bit and the next
//            one's first: an interrupt, in RAM, of the highest priority. Up to 1 MHz
//   Effects  of reads and writes come when the transfer is over (Transfer), together, in their order;
//            an answer within a transfer does not know of them
//   Counted  late_rearm: the next transfer began before this one was cleared away, and its answers may
//            be wrong. overflow: more bytes were written than are kept
//   Pins     SPI1 on PA15, PB3, PB4, PB5, mode 3
#pragma once
#include <array>
#include <cstdint>

#include "io_bridges/devices/core/mpu6000_registers.hpp"

namespace fw::pod {

struct Transfer {
  static constexpr std::size_t kMostWritten = 16;
  bool read = false, burst = false;
  std::uint8_t first = 0;   // register
  std::uint32_t count = 0;  // data bytes that passed; of a burst, which DMA sends, all of it
  std::array<std::uint8_t, kMostWritten> written{};
};

struct SpiCounters {
  std::uint32_t transfers = 0, bursts = 0, late_rearm = 0, overflow = 0;
};

// The read that is expected next: the measured values. Fixed here, for in the half period nothing is to be fetched.
inline constexpr std::uint8_t kBurstCommand = 0x80 | whirl::core::mpu::ACCEL_XOUT_H;
inline constexpr std::uint32_t kBurstBytes = 14;

void start_spi_slave();
// What each register answers from the next transfer on, and what a burst does. Pre: not selected, and
// the caller keeps kPriorityParts out.
void arm_spi_slave(const std::uint8_t* answers);
bool spi_selected();
const SpiCounters& spi_counters();

// Supplied by the application; from the interrupt at chip select's rise, kPriorityParts: applies the
// effects. The next transfer may have begun, with the answers as they were armed.
void transfer_over(const Transfer& transfer);

}  // namespace fw::pod

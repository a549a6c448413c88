// What a receiver makes of a character that was sent with other settings: it samples the bits of
// the sender's waveform at its own rate, three times in the middle of each bit (RM0090 30.3.3).
//
//   Valid     the sender's next character is taken to follow at once: a receiver that is too slow
//             samples its start bit where it wants a stop bit
#pragma once
#include <cstdint>

#include "io_bridges/devices/bus.hpp"

namespace whirl::stm32 {

struct UartSample {
  std::uint16_t bits = 0;  // data and parity bit as received, LSB first
  bool stop_missing = false;
  bool noise = false;  // the three samples of a bit differed
};

// rx_bits: data bits and parity bit that the receiver expects; rx_baud: its rate.
UartSample sample_uart(const io::UartByte& byte, const io::UartFormat& format, int rx_bits,
                       double rx_baud);

bool odd_number_of_ones(std::uint32_t value);

}  // namespace whirl::stm32

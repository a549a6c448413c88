// What a receiver makes of a character that was sent with other settings: it samples the bits of
// the sender's waveform at its own rate, three times in the middle of each bit (RM0090 30.3.3).
//
//   Valid     the sender's next character is taken to follow at once: a receiver that is too slow
//             samples its start bit where it wants a stop bit
//   Inverted  a receiver begins at the first fall of the line within the character, and takes the line
//             to be low, as it idles, behind its end. That it sees a break while nothing is sent is left
//             out: nothing is announced between characters
#pragma once
#include <cstdint>

#include "io_bridges/devices/bus.hpp"

namespace whirl::io {

struct UartSample {
  std::uint16_t bits = 0;  // data and parity bit as received, LSB first
  bool stop_missing = false;
  bool noise = false;  // the three samples of a bit differed
};

// rx_bits: data bits and parity bit that the receiver expects; rx_baud: its rate.
UartSample sample_uart(const UartByte& byte, const UartFormat& format, int rx_bits, double rx_baud);

bool odd_number_of_ones(std::uint32_t value);

}  // namespace whirl::io

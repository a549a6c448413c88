#include "io_bridges/devices/uart_sampling.hpp"

#include <cmath>

namespace whirl::io {
namespace {

// Levels on the line from the start bit on; bit i of the result is the i-th bit time.
std::uint32_t waveform(const UartByte& byte, const UartFormat& format, int& length) {
  if (byte.is_break) {
    length = 32;
    return 0;
  }
  const std::uint32_t data = byte.value & ((1u << format.data_bits) - 1);
  std::uint32_t wave = data << 1;
  length = 1 + format.data_bits;
  if (format.parity != 'N') {
    const bool parity = odd_number_of_ones(data) != (format.parity == 'O');
    if (parity) wave |= 1u << length;
    ++length;
  }
  if (!byte.framing_error) wave |= 1u << length;
  return wave;  // stop bits beyond the first are idle line
}

// As a receiver takes it that knows nothing of the inversion: its start bit is the first low level
// behind a high one.
std::uint32_t inverted_from_its_fall(std::uint32_t wave, int& length) {
  wave = ~wave & ((1u << (length + 1)) - 1);
  int fall = 0;
  while (fall < length && ((wave >> fall) & 1) != 0) ++fall;
  length -= fall;
  return wave >> fall;
}

}  // namespace

bool odd_number_of_ones(std::uint32_t value) {
  return (__builtin_popcount(value) & 1) != 0;
}

UartSample sample_uart(const UartByte& byte, const UartFormat& format, int rx_bits,
                       double rx_baud) {
  int length = 0;
  std::uint32_t wave = waveform(byte, format, length);
  if (format.inverted && !byte.is_break) wave = inverted_from_its_fall(wave, length);
  const double ratio = rx_baud > 0.0 ? format.baud / rx_baud : 1.0;
  const bool matched = std::abs(ratio - 1.0) < 0.01;
  const auto level_at = [&](double rx_bit_times) {
    const int i = static_cast<int>(matched ? rx_bit_times : rx_bit_times * ratio);
    if (i <= length) return ((wave >> i) & 1) != 0;
    if (format.inverted) return false;
    return matched;  // beyond the stop bit: idle, or already the next start bit
  };
  UartSample out;
  out.noise = byte.noise;
  for (int k = 1; k <= rx_bits + 1; ++k) {
    int ones = 0;
    for (const double at : {7.5 / 16, 8.5 / 16, 9.5 / 16}) ones += level_at(k + at) ? 1 : 0;
    if (ones == 1 || ones == 2) out.noise = true;
    if (k <= rx_bits) {
      if (ones >= 2) out.bits = static_cast<std::uint16_t>(out.bits | (1u << (k - 1)));
    } else {
      out.stop_missing = ones < 2;
    }
  }
  return out;
}

}  // namespace whirl::io

// Waveforms drawn by hand: a start bit low, data low bit first, parity, stop high.
#include "io_bridges/devices/uart_sampling.hpp"

#include <gtest/gtest.h>

namespace whirl::io {
namespace {

const UartFormat kSbus{100000.0, 8, 'E', 2.0, false};

TEST(UartSampling, EvenParityIsTheNinthBit) {
  for (const auto& [value, ninth] : {std::pair{0x0F, 0}, {0xE0, 1}, {0x00, 0}, {0x01, 1}}) {
    const auto sample =
        sample_uart({.value = static_cast<std::uint8_t>(value)}, kSbus, 9, 100000.0);
    EXPECT_EQ(sample.bits, value | ninth << 8);
    EXPECT_FALSE(sample.stop_missing);
    EXPECT_FALSE(odd_number_of_ones(sample.bits));
  }
}

// 0x0F inverted: start 1, 0000 1111, parity 1, stop 0. The line falls after the start bit: that fall is
// taken for a start bit, then 000 1111 1 are data, the inverted stop bit follows, and there the line is low.
TEST(UartSampling, AnInvertedLineIsReadFromItsFirstFall) {
  UartFormat inverted = kSbus;
  inverted.inverted = true;
  const auto sample = sample_uart({.value = 0x0F}, inverted, 9, 100000.0);
  EXPECT_EQ(sample.bits, 0b0'1111'1000);
  EXPECT_TRUE(sample.stop_missing);
}

TEST(UartSampling, TooFastASenderIsGarbage) {
  const auto sample = sample_uart({.value = 0x55}, {19200.0, 8, 'N', 1.0}, 8, 9600.0);
  EXPECT_NE(sample.bits & 0xFF, 0x55);
}

}  // namespace
}  // namespace whirl::io

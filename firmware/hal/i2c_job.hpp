// One transaction on I2C, as a task asks for it.
#pragma once
#include <array>
#include <cstdint>

namespace fw::hal {

struct I2cJob {
  static constexpr std::size_t kMaxLength = 8;
  std::uint8_t address = 0;
  bool read = false;
  std::uint8_t length = 0;   // a read is of two bytes at least
  std::uint8_t retries = 1;  // after a NACK or a bus error
  std::array<std::uint8_t, kMaxLength> bytes{};
};

}  // namespace fw::hal

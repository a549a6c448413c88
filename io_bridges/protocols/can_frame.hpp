// One frame of classic CAN (2.0A and B), as a controller hands it over: no stuff bits, no CRC.
//
//   Valid     id below 2^11, or below 2^29 if extended; length 0..8; bytes beyond length are zero
//   Left out  CAN FD; error frames, which are no frames (io_bridges/socketcan says what it was told of them)
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace whirl::io {

struct CanFrame {
  std::uint32_t id = 0;
  bool extended = false;
  bool remote = false;  // asks for data: carries a length and no bytes
  std::uint8_t length = 0;
  std::array<std::uint8_t, 8> data{};

  std::span<const std::uint8_t> bytes() const {
    return std::span(data).first(remote || length > 8 ? 0 : length);
  }
  bool operator==(const CanFrame&) const = default;
};

// Bits on the wire from start of frame to the end of the intermission, without and with the most stuff
// bits that its length allows (one in five of what is stuffed, less the first): an average lies between.
constexpr int bits_unstuffed(bool extended, int data_bytes) {
  return (extended ? 67 : 47) + 8 * data_bytes;
}
constexpr int bits_stuffed_at_most(bool extended, int data_bytes) {
  const int stuffed = (extended ? 54 : 34) + 8 * data_bytes;
  return bits_unstuffed(extended, data_bytes) + (stuffed - 1) / 4;
}

}  // namespace whirl::io

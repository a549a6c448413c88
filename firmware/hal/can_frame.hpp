// A data frame on CAN with an identifier of 29 bits, and what a node takes of the others'.
#pragma once
#include <array>
#include <cstdint>

namespace fw::hal {

struct CanFrame {
  std::uint32_t id = 0;  // 29 bits; the lower goes first
  std::uint8_t length = 0;
  std::array<std::uint8_t, 8> data{};

  bool operator==(const CanFrame&) const = default;
};

// A frame passes that equals `id` in all bits of `mask`.
struct CanFilter {
  std::uint32_t id = 0, mask = 0;
};

struct CanCounters {  // never decremented
  std::uint32_t received = 0, sent = 0;
  std::uint32_t lost = 0;     // received, and no room: in the block or in the ring
  std::uint32_t dropped = 0;  // given to send(), and not sent
  std::uint32_t passive = 0, bus_off = 0;
};

}  // namespace fw::hal

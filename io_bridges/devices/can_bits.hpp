// A CAN frame as the bits that are on the wire (ISO 11898-1): what decides an arbitration, where the
// stuff bits stand, how long it takes.
//
//   Values   0 is dominant, 1 recessive
#pragma once
#include <array>
#include <cstdint>

#include "io_bridges/protocols/can_frame.hpp"

namespace whirl::io {

// Behind the stuffed bits: CRC delimiter, acknowledge slot and its delimiter, end of frame; then the
// intermission, which belongs to nobody.
inline constexpr int kCanAckSlotAfter = 1, kCanTail = 3 + 7, kCanIntermission = 3;
inline constexpr int kCanErrorFlag = 6, kCanErrorDelimiter = 8, kCanSuspend = 8, kCanIdle = 11;

struct CanBits {  // from start of frame to the end of the CRC, stuff bits included
  std::array<std::uint8_t, 160> value{};
  int count = 0;
};
CanBits can_bits(const CanFrame& frame);

// With everything behind, the intermission too.
inline int can_frame_bits(const CanFrame& frame) {
  return can_bits(frame).count + kCanTail + kCanIntermission;
}

// The arbitration field, its first bit highest: of two frames the lower goes on.
std::uint32_t can_arbitration(const CanFrame& frame);
// The first bit of that field (0: the identifier's first) in which two differ; 32: none.
int can_bit_lost(std::uint32_t winner, std::uint32_t loser);

}  // namespace whirl::io

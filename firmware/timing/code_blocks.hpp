// Long pieces of code in flash, to be entered anywhere: what they cost tells how code is fetched.
//
//   straight_16, straight_32   additions of 16 and of 32 bits without a branch
//   jumps                      a taken branch every 48 bytes: each to another line of flash, and never to
//                              the next one, which a prefetch would have
//   delay                      the loop of two instructions, its count in r0
//   Call                       as a function; r0 is lost, nothing else
#pragma once
#include <cstdint>

namespace fw::timing {

inline constexpr std::uint32_t kLine_bytes = 16, kJump_bytes = 48;
#ifdef __ARM_FP
inline constexpr std::uint32_t kStraight_bytes = 64 * 1024, kJumps = 128;
#else
inline constexpr std::uint32_t kStraight_bytes = 16 * 1024, kJumps = 128;
#endif

using Block = std::uint32_t (*)(std::uint32_t argument);

// The last `bytes` of a block and its return.
Block straight_16(std::uint32_t bytes);
Block straight_32(std::uint32_t bytes);
Block jumps(std::uint32_t count);

// Copies the last `bytes` and the return to `to`, which is a multiple of 16; the copy's entry.
Block copied(Block block, std::uint32_t bytes, std::uint16_t* to);
Block delay();
inline constexpr std::uint32_t kDelay_bytes = 4;

}  // namespace fw::timing

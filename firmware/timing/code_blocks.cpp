#include "firmware/timing/code_blocks.hpp"

#include <bit>

#ifdef __ARM_FP
#define FW_STRAIGHT_16 "32768"
#define FW_STRAIGHT_32 "16384"
#else
#define FW_STRAIGHT_16 "8192"
#define FW_STRAIGHT_32 "4096"
#endif
#define FW_BLOCK(name, code)                                                                \
  __asm(".syntax unified\n.thumb\n.section .text." name                                     \
        ",\"ax\",%progbits\n.balign 64\n.global " name "\n.type " name ", %function\n" name \
        ":\n" code "\n.global " name "_end\n" name                                          \
        "_end:\n bx lr\n nop.n\n nop.n\n nop.n\n .balign 16\n.section .text\n")

FW_BLOCK("block_straight_16", ".rept " FW_STRAIGHT_16 "\n adds.n r0, r0, #1\n .endr");
FW_BLOCK("block_straight_32", ".rept " FW_STRAIGHT_32 "\n add.w r0, r0, #1\n .endr");
FW_BLOCK("block_jumps", ".rept 128\n b.n 1f\n .rept 23\n nop.n\n .endr\n 1:\n .endr");
FW_BLOCK("block_delay", "1: subs.n r0, r0, #1\n bne.n 1b");

extern "C" {
extern const std::uint16_t block_straight_16_end[], block_straight_32_end[], block_jumps_end[],
    block_delay[];
}

namespace fw::timing {
namespace {

Block entry(const std::uint16_t* code) {
  return std::bit_cast<Block>(std::bit_cast<std::uint32_t>(code) | 1u);
}

}  // namespace

Block straight_16(std::uint32_t bytes) {
  return entry(block_straight_16_end - bytes / 2);
}

Block straight_32(std::uint32_t bytes) {
  return entry(block_straight_32_end - bytes / 2);
}

Block jumps(std::uint32_t count) {
  return entry(block_jumps_end - count * (kJump_bytes / 2));
}

Block delay() {
  return entry(block_delay);
}

Block copied(Block block, std::uint32_t bytes, std::uint16_t* to) {
  const auto* from =
      std::bit_cast<const volatile std::uint16_t*>(std::bit_cast<std::uint32_t>(block) & ~1u);
  volatile std::uint16_t* out = to;
  for (std::uint32_t i = 0; i < bytes / 2 + 2; ++i)
    out[i] = from[i];  // bx lr and what is fetched behind
  __asm volatile("dsb\n isb" ::: "memory");
  return entry(to);
}

}  // namespace fw::timing

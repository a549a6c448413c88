// Loops as programs have them: delays, copies, and jumps through memory. Each loops inside its body.
#include "firmware/timing/kernel.hpp"

// clang-format off
#define FW_LOOP_KERNELS(X)                                                                         \
  X(empty, 1, "", "")                                                                              \
  X(delay_loop, 200, "movs r0, #200", "1: subs.n r0, r0, #1\n bne.n 1b")                           \
  X(delay_loop_unaligned, 200, "movs r0, #200", "nop.n\n 1: subs.n r0, r0, #1\n bne.n 1b")         \
  X(delay_loop_wide, 200, "movs r0, #200", "nop.n\n 1: subs.w r0, r0, #1\n bne.w 1b")              \
  X(ldr_pc, 64, "adr.w r0, 1f\n orr.w r0, r0, #1\n str r0, [r4]\n movs r1, #64",                   \
    ".balign 4\n 1: subs.n r1, r1, #1\n beq.n 2f\n ldr.w pc, [r4]\n 2:")                           \
  X(copy_bytes, 200, "mov r0, r5\n mov r1, r4\n movs r2, #200",                                    \
    "1: ldrb.w r3, [r1], #1\n strb.w r3, [r0], #1\n subs.n r2, r2, #1\n bne.n 1b")                 \
  X(copy_words, 60, "mov r0, r5\n mov r1, r4\n movs r2, #60",                                      \
    "1: ldr.w r3, [r1], #4\n str.w r3, [r0], #4\n subs.n r2, r2, #1\n bne.n 1b")                   \
  X(copy_ldm_stm, 16, "mov r0, r5\n mov r1, r4\n movs r2, #16",                                    \
    "1: ldmia.w r1!, {r3, r6, r10, r12}\n stmia.w r0!, {r3, r6, r10, r12}\n subs.n r2, r2, #1\n"   \
    "bne.n 1b")                                                                                    \
  X(sum_of_array, 60, "mov r1, r4\n movs r2, #60\n movs r0, #0",                                   \
    "1: ldr.w r3, [r1], #4\n add.w r0, r0, r3\n subs.n r2, r2, #1\n bne.n 1b")
// clang-format on

#define FW_LOOP_CODE(name, count, setup, body) FW_KERNEL_CODE(name, 1, setup, body)

FW_LOOP_KERNELS(FW_LOOP_CODE)

namespace fw::timing {
namespace {
constexpr Kernel kKernels[] = {FW_LOOP_KERNELS(FW_KERNEL_ENTRY)};
}

std::span<const Kernel> loop_kernels() {
  return kKernels;
}

}  // namespace fw::timing

// Branches: taken and not, by width, and by alignment and width of the target.
#include "firmware/timing/kernel.hpp"

__asm(
    ".syntax unified\n.thumb\n.section .text.kernel_callees,\"ax\",%progbits\n.balign 16\n"
    ".global kernel_callee\n.type kernel_callee, %function\nkernel_callee: bx lr\n"
    ".balign 16\n.global kernel_callee_pop\n.type kernel_callee_pop, %function\n"
    "kernel_callee_pop: push {r0, lr}\n pop {r0, pc}\n.section .text\n");

// clang-format off
#define FW_BRANCH_KERNELS(X)                                                                       \
  X(b_not_taken_16, 128, "cmp r7, #1", "beq.n 1f\n 1:")                                            \
  X(b_not_taken_32, 64, "cmp r7, #1", "beq.w 1f\n 1:")                                             \
  X(b_16_to_aligned_16, 32, "", "b.n 1f\n nop.n\n 1: adds.n r0, r0, #1\n adds.n r0, r0, #1")       \
  X(b_16_to_unaligned_16, 32, "", "b.n 1f\n nop.n\n nop.n\n 1: adds.n r0, r0, #1")                 \
  X(b_16_to_aligned_32, 32, "", "b.n 1f\n nop.n\n 1: add.w r0, r0, #1")                            \
  X(b_16_to_unaligned_32, 32, "", "b.n 1f\n nop.n\n nop.n\n 1: add.w r0, r0, #1\n"                 \
                                  "adds.n r0, r0, #1")                                             \
  X(b_32_to_aligned_16, 32, "", "b.w 1f\n nop.w\n 1: adds.n r0, r0, #1\n adds.n r0, r0, #1")       \
  X(b_32_to_unaligned_32, 32, "", "b.w 1f\n nop.n\n 1: add.w r0, r0, #1\n adds.n r0, r0, #1")      \
  X(b_conditional_taken, 32, "cmp r7, #1", "bne.n 1f\n nop.n\n 1: adds.w r0, r1, #1")              \
  X(b_after_compare, 32, "", "cmp.n r7, #0\n beq.n 1f\n nop.w\n 1: add.w r0, r0, #1")              \
  X(cbz_not_taken, 64, "movs r1, #1", "cbz r1, 1f\n adds.n r0, r0, #1\n 1:")                       \
  X(cbz_taken, 32, "movs r1, #0", "cbz r1, 1f\n nop.n\n 1: add.w r0, r0, #1")                      \
  X(bl_bx, 32, "", "bl kernel_callee")                                                             \
  X(blx_bx, 32, "ldr r5, =kernel_callee", "blx r5\n nop.n")                                        \
  X(call_push_pop, 32, "", "bl kernel_callee_pop")                                                 \
  X(tbb, 32, "", "tbb [pc, r7]\n .byte 1, 1\n 1: adds.n r0, r0, #1")                               \
  X(tbh, 32, "", "tbh [pc, r7, lsl #1]\n .hword 1\n 1: adds.n r0, r0, #1")
// clang-format on

FW_BRANCH_KERNELS(FW_KERNEL_CODE)

namespace fw::timing {
namespace {

constexpr Kernel kKernels[] = {FW_BRANCH_KERNELS(FW_KERNEL_ENTRY)};

}  // namespace

std::span<const Kernel> branch_kernels() {
  return kKernels;
}

}  // namespace fw::timing

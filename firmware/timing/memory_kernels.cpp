// Loads and stores of RAM, and of literals beside the code.
#include "firmware/timing/kernel.hpp"

// clang-format off
#define FW_MEMORY_KERNELS(X)                                                                       \
  X(ldr_row, 128, "", "ldr.n r0, [r4]")                                                            \
  X(ldr_alone, 64, "", "ldr.n r0, [r4]\n adds.n r1, r1, #1")                                       \
  X(ldr_used, 64, "", "ldr.n r0, [r4]\n adds.n r0, r0, #1")                                        \
  X(ldr_chain, 64, "str r4, [r4]\n mov r0, r4", "ldr.n r0, [r0]")                                  \
  X(ldr_computed_address, 64, "", "add.w r0, r4, #0\n ldr.n r1, [r0]")                             \
  X(ldr_register_offset, 64, "", "ldr.w r0, [r4, r7]\n adds.n r1, r1, #1")                         \
  X(ldr_post_index, 64, "mov r1, r4", "ldr.w r0, [r1], #4\n adds.n r2, r2, #1")                    \
  X(ldrb_row, 128, "", "ldrb.n r0, [r4]")                                                          \
  X(ldrsh_row, 128, "", "ldrsh.w r0, [r4]")                                                        \
  X(ldr_unaligned, 64, "", "ldr.w r0, [r4, #1]\n adds.n r1, r1, #1")                               \
  X(str_row, 128, "", "str.n r0, [r4]")                                                            \
  X(str_alone, 64, "", "str.n r0, [r4]\n adds.n r1, r1, #1")                                       \
  X(str_register_offset, 64, "", "str.w r0, [r4, r7]\n adds.n r1, r1, #1")                         \
  X(strb_row, 128, "", "strb.n r0, [r4]")                                                          \
  X(ldr_str, 64, "", "ldr.n r0, [r4]\n str.n r0, [r5]")                                            \
  X(ldr_str_add, 64, "", "ldr.n r0, [r4]\n str.n r1, [r5]\n adds.n r2, r2, #1")                    \
  X(ldr_ldr_add, 64, "", "ldr.n r0, [r4]\n ldr.n r1, [r5]\n adds.n r2, r2, #1")                    \
  X(ldr_3_add, 64, "", "ldr.n r0, [r4]\n ldr.n r1, [r5]\n ldr.n r2, [r6]\n adds.n r3, r3, #1")     \
  X(ldrd, 64, "", "ldrd r0, r1, [r4]")                                                             \
  X(strd, 64, "", "strd r0, r1, [r4]")                                                             \
  X(ldm_2, 64, "", "ldm.w r4, {r0, r1}")                                                           \
  X(ldm_4, 32, "", "ldm.w r4, {r0, r1, r2, r3}")                                                   \
  X(ldm_8, 32, "", "ldm.w r6, {r0, r1, r2, r3, r4, r10, r12, lr}")                                   \
  X(stm_2, 64, "", "stm.w r4, {r0, r1}")                                                           \
  X(stm_4, 32, "", "stm.w r4, {r0, r1, r2, r3}")                                                   \
  X(stm_8, 32, "", "stm.w r4, {r0, r1, r2, r3, r5, r10, r12, lr}")                                 \
  X(push_pop_2, 32, "", "push {r0, r1}\n pop {r0, r1}")                                            \
  X(push_pop_4, 32, "", "push {r0, r1, r2, r3}\n pop {r0, r1, r2, r3}")                            \
  X(push_pop_8, 16, "", "push.w {r0, r1, r2, r3, r5, r10, r12, lr}\n"                              \
                        "pop.w {r0, r1, r2, r3, r5, r10, r12, lr}")                                \
  X(ldrex_strex, 32, "", "ldrex r0, [r4]\n strex r1, r0, [r4]")
#define FW_LITERAL_KERNELS(X)                                                                      \
  X(literal_row, 64, "", "ldr.w r0, =0x12345678")                                                  \
  X(literal_alone, 32, "", "ldr.w r0, =0x12345678\n adds.n r1, r1, #1\n adds.n r2, r2, #1\n"       \
                           "adds.n r3, r3, #1")
// clang-format on

FW_MEMORY_KERNELS(FW_KERNEL_CODE)
FW_LITERAL_KERNELS(FW_KERNEL_CODE)

namespace fw::timing {
namespace {
constexpr Kernel kKernels[] = {FW_MEMORY_KERNELS(FW_KERNEL_ENTRY)};
constexpr Kernel kLiterals[] = {FW_LITERAL_KERNELS(FW_KERNEL_ENTRY)};
}  // namespace

std::span<const Kernel> memory_kernels() {
  return kKernels;
}

std::span<const Kernel> literal_kernels() {
  return kLiterals;
}

}  // namespace fw::timing

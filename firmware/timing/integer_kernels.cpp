// Data processing: one instruction class each.
#include "firmware/timing/kernel.hpp"

// clang-format off
#define FW_INTEGER_KERNELS(X)                                                                      \
  X(add_16, 128, "", "adds.n r0, r0, #1")                                                          \
  X(add_32, 128, "", "add.w r0, r0, #1")                                                           \
  X(add_32_unaligned, 32, "", "adds.n r0, r0, #1\n add.w r1, r1, #1\n add.w r2, r2, #1\n"          \
                              "adds.n r3, r3, #1")                                                 \
  X(add_independent, 32, "", "adds.n r0, r0, #1\n adds.n r1, r1, #1\n adds.n r2, r2, #1\n"         \
                             "adds.n r3, r3, #1")                                                  \
  X(mov_high, 128, "", "mov r12, r11")                                                             \
  X(movw_movt, 64, "", "movw r0, #0x1234\n movt r0, #0x5678")                                      \
  X(compare, 128, "", "cmp.n r0, r1")                                                              \
  X(shift_16, 128, "movs r0, #1", "lsls.n r0, r0, #1")                                             \
  X(shift_32, 128, "movs r1, #9", "lsr.w r0, r1, #3")                                              \
  X(rotate_register, 128, "movs r1, #9\n movs r2, #3", "ror.w r0, r1, r2")                         \
  X(add_shifted, 128, "movs r1, #9\n movs r2, #3", "add.w r0, r1, r2, lsl #3")                     \
  X(clz, 128, "movs r1, #9", "clz r0, r1")                                                         \
  X(sxth_16, 128, "movs r1, #9", "sxth.n r0, r1")                                                  \
  X(uxtb_rotated, 128, "movs r1, #9", "uxtb.w r0, r1, ror #8")                                     \
  X(bfi, 128, "movs r1, #9", "bfi r0, r1, #4, #8")                                                 \
  X(ubfx, 128, "movs r1, #9", "ubfx r0, r1, #4, #8")                                               \
  X(rbit, 128, "movs r1, #9", "rbit r0, r1")                                                       \
  X(ssat, 128, "movs r1, #9", "ssat r0, #8, r1")                                                   \
  X(mul_16, 128, "movs r0, #3\n movs r1, #5", "muls.n r0, r1, r0")                                 \
  X(mul_32, 128, "movs r1, #5\n movs r2, #7", "mul.w r0, r1, r2")                                  \
  X(mla, 64, "movs r1, #5\n movs r2, #7", "mla r0, r1, r2, r3")                                    \
  X(mla_chain, 64, "movs r1, #5\n movs r2, #7", "mla r0, r1, r2, r0")                              \
  X(mls, 64, "movs r1, #5\n movs r2, #7", "mls r0, r1, r2, r3")                                    \
  X(umull_small, 64, "movs r2, #5\n movs r3, #7", "umull r0, r1, r2, r3")                          \
  X(umull_large, 64, "mvn.w r2, #0\n mvn.w r3, #0", "umull r0, r1, r2, r3")                        \
  X(smull_large, 64, "mvn.w r2, #0x80000000\n mov r3, r2", "smull r0, r1, r2, r3")                 \
  X(umlal_large, 64, "mvn.w r2, #0\n mvn.w r3, #0", "umlal r0, r1, r2, r3")                        \
  X(smlal_large, 64, "mvn.w r2, #0x80000000\n mov r3, r2", "smlal r0, r1, r2, r3")                 \
  X(udiv_small, 64, "movs r1, #7\n movs r2, #3", "udiv r0, r1, r2")                                \
  X(udiv_large, 64, "mvn.w r1, #0\n movs r2, #3", "udiv r0, r1, r2")                               \
  X(udiv_large_by_large, 64, "mvn.w r1, #0\n lsr.w r2, r1, #1", "udiv r0, r1, r2")                 \
  X(udiv_zero, 64, "movs r1, #0\n movs r2, #3", "udiv r0, r1, r2")                                 \
  X(udiv_by_zero, 64, "movs r1, #7\n movs r2, #0", "udiv r0, r1, r2")                              \
  X(udiv_equal, 64, "movw r1, #12345\n mov r2, r1", "udiv r0, r1, r2")                             \
  X(sdiv_negative, 64, "mvn.w r1, #6\n movs r2, #3", "sdiv r0, r1, r2")                            \
  X(sdiv_large, 64, "mvn.w r1, #0x80000000\n movs r2, #3", "sdiv r0, r1, r2")                      \
  X(divide_then_add, 32, "movw r1, #12345\n movs r2, #3", "udiv r0, r1, r2\n adds.n r3, r3, #1\n"  \
                                                          "adds.n r3, r3, #1")                     \
  X(it_taken, 64, "cmp r7, #0", "it eq\n addeq.n r0, r0, #1")                                      \
  X(it_not_taken, 64, "cmp r7, #0", "it ne\n addne.n r0, r0, #1")                                  \
  X(ittt_taken, 32, "cmp r7, #0", "ittt eq\n addeq.n r0, r0, #1\n addeq.n r1, r1, #1\n"            \
                                  "addeq.n r2, r2, #1")                                            \
  X(ittt_not_taken, 32, "cmp r7, #0", "ittt ne\n addne.n r0, r0, #1\n addne.n r1, r1, #1\n"        \
                                      "addne.n r2, r2, #1")                                        \
  X(ite_one_of_two, 32, "cmp r7, #0", "ite eq\n addeq.n r0, r0, #1\n addne.n r1, r1, #1")          \
  X(nop_16, 128, "", "nop.n")                                                                      \
  X(read_primask, 64, "", "mrs r0, primask")
#define FW_DSP_KERNELS(X)                                                                          \
  X(smlad, 64, "movs r1, #5\n movs r2, #7", "smlad r0, r1, r2, r3")                                \
  X(smulbb, 64, "movs r1, #5\n movs r2, #7", "smulbb r0, r1, r2")                                  \
  X(sadd16, 64, "movs r1, #5\n movs r2, #7", "sadd16 r0, r1, r2")                                  \
  X(qadd, 64, "movs r1, #5\n movs r2, #7", "qadd r0, r1, r2")                                      \
  X(sel, 64, "movs r1, #5\n movs r2, #7", "sel r0, r1, r2")
// clang-format on

FW_INTEGER_KERNELS(FW_KERNEL_CODE)
#ifdef __ARM_FEATURE_DSP
FW_DSP_KERNELS(FW_KERNEL_CODE)
#else
#undef FW_DSP_KERNELS
#define FW_DSP_KERNELS(X)
#endif

namespace fw::timing {
namespace {
constexpr Kernel kKernels[] = {FW_INTEGER_KERNELS(FW_KERNEL_ENTRY) FW_DSP_KERNELS(FW_KERNEL_ENTRY)};
}

std::span<const Kernel> integer_kernels() {
  return kKernels;
}

}  // namespace fw::timing

// The FPU: throughput, chains, and what runs beside a division.
#include "firmware/timing/kernel.hpp"

#if defined(__ARM_FP) && (__ARM_FP & 4)
// clang-format off
#define FW_ONES                                                           \
  "vmov.f32 s0, #1.0\n vmov.f32 s1, #1.5\n vmov.f32 s2, #2.0\n"           \
  "vmov.f32 s3, #1.0\n vmov.f32 s4, #1.0\n vmov.f32 s5, #1.0\n"           \
  "vmov.f32 s6, #1.0\n vmov.f32 s7, #1.0\n"
#define FW_ADDS_4 "adds.n r0, r0, #1\n adds.n r1, r1, #1\n adds.n r2, r2, #1\n adds.n r3, r3, #1\n"

#define FW_FLOAT_KERNELS(X)                                                                        \
  X(vadd, 32, FW_ONES, "vadd.f32 s4, s0, s1\n vadd.f32 s5, s0, s1\n vadd.f32 s6, s0, s1\n"         \
                       "vadd.f32 s7, s0, s1")                                                      \
  X(vadd_chain, 64, FW_ONES, "vadd.f32 s0, s0, s1")                                                \
  X(vmul, 32, FW_ONES, "vmul.f32 s4, s0, s1\n vmul.f32 s5, s0, s1\n vmul.f32 s6, s0, s1\n"         \
                       "vmul.f32 s7, s0, s1")                                                      \
  X(vmul_chain, 64, FW_ONES, "vmul.f32 s0, s0, s3")                                                \
  X(vmul_vadd_chain, 32, FW_ONES, "vmul.f32 s4, s0, s3\n vadd.f32 s0, s4, s1")                     \
  X(vmla, 16, FW_ONES, "vmla.f32 s4, s0, s1\n vmla.f32 s5, s0, s1\n vmla.f32 s6, s0, s1\n"         \
                       "vmla.f32 s7, s0, s1")                                                      \
  X(vmla_chain, 32, FW_ONES, "vmla.f32 s4, s0, s1")                                                \
  X(vfma, 16, FW_ONES, "vfma.f32 s4, s0, s1\n vfma.f32 s5, s0, s1\n vfma.f32 s6, s0, s1\n"         \
                       "vfma.f32 s7, s0, s1")                                                      \
  X(vfma_chain, 32, FW_ONES, "vfma.f32 s4, s0, s1")                                                \
  X(vneg, 64, FW_ONES, "vneg.f32 s4, s0")                                                          \
  X(vabs, 64, FW_ONES, "vabs.f32 s4, s0")                                                          \
  X(vdiv, 32, FW_ONES, "vdiv.f32 s4, s0, s1")                                                      \
  X(vdiv_used, 32, FW_ONES, "vdiv.f32 s4, s0, s1\n vadd.f32 s5, s4, s0")                           \
  X(vdiv_beside_8_adds, 16, FW_ONES, "vdiv.f32 s4, s0, s1\n" FW_ADDS_4 FW_ADDS_4)                  \
  X(vdiv_beside_20_adds, 16, FW_ONES, "vdiv.f32 s4, s0, s1\n" FW_ADDS_4 FW_ADDS_4 FW_ADDS_4        \
                                      FW_ADDS_4 FW_ADDS_4)                                         \
  X(vsqrt, 32, FW_ONES, "vsqrt.f32 s4, s1")                                                        \
  X(vsqrt_beside_8_adds, 16, FW_ONES, "vsqrt.f32 s4, s1\n" FW_ADDS_4 FW_ADDS_4)                    \
  X(vcmp_vmrs, 64, FW_ONES, "vcmp.f32 s0, s1\n vmrs APSR_nzcv, fpscr")                             \
  X(vmrs, 64, "", "vmrs r0, fpscr")                                                                \
  X(vcvt_to_float, 64, FW_ONES, "vcvt.f32.s32 s4, s0\n adds.n r0, r0, #1")                         \
  X(vcvt_to_integer, 64, FW_ONES, "vcvt.s32.f32 s4, s0\n adds.n r0, r0, #1")                       \
  X(vmov_to_fpu, 64, "", "vmov s4, r0")                                                            \
  X(vmov_from_fpu, 64, "", "vmov r0, s4")                                                          \
  X(vmov_constant, 64, "", "vmov.f32 s4, #1.0")                                                    \
  X(vldr_alone, 64, "", "vldr s4, [r4]\n adds.n r0, r0, #1")                                       \
  X(vldr_row, 64, "", "vldr s4, [r4]")                                                             \
  X(vldr_double, 32, "", "vldr d2, [r4]\n adds.n r0, r0, #1")                                      \
  X(vstr_alone, 64, "", "vstr s4, [r4]\n adds.n r0, r0, #1")                                       \
  X(vstr_row, 64, "", "vstr s4, [r4]")                                                             \
  X(vldm_4, 32, "", "vldm r4, {s4-s7}")                                                            \
  X(vldm_8, 32, "", "vldm r4, {s0-s7}")                                                            \
  X(vstm_4, 32, "", "vstm r4, {s4-s7}")                                                            \
  X(vpush_vpop_4, 32, "", "vpush {s4-s7}\n vpop {s4-s7}")
// clang-format on

FW_FLOAT_KERNELS(FW_KERNEL_CODE)

namespace fw::timing {
namespace {
constexpr Kernel kKernels[] = {FW_FLOAT_KERNELS(FW_KERNEL_ENTRY)};
}

std::span<const Kernel> float_kernels() {
  return kKernels;
}

}  // namespace fw::timing

#else

namespace fw::timing {

std::span<const Kernel> float_kernels() {
  return {};
}

}  // namespace fw::timing
#endif

// Registers of peripherals: TIM2 on APB1, the pins of port A on AHB1 (STM32F405) or APB2 (STM32F103).
#include "firmware/timing/kernel.hpp"

#ifdef __ARM_FP
#define FW_PINS "movw r1, #0x0010\n movt r1, #0x4002"
#else
#define FW_PINS "movw r1, #0x0808\n movt r1, #0x4001"
#endif
#define FW_ADDS "adds.n r2, r2, #1\n adds.n r2, r2, #1\n adds.n r2, r2, #1\n adds.n r2, r2, #1\n"

// TIM2_ARR: reading and writing it moves nothing, as the timer stands.
// clang-format off
#define FW_BUS_KERNELS(X)                                                                          \
  X(apb1_read_row, 64, "mov.w r1, #0x40000000", "ldr.n r0, [r1, #44]")                             \
  X(apb1_read_alone, 32, "mov.w r1, #0x40000000", "ldr.n r0, [r1, #44]\n" FW_ADDS)                 \
  X(apb1_write_row, 64, "mov.w r1, #0x40000000", "str.n r0, [r1, #44]")                            \
  X(apb1_write_alone, 32, "mov.w r1, #0x40000000", "str.n r0, [r1, #44]\n" FW_ADDS FW_ADDS)        \
  X(pins_read_row, 64, FW_PINS, "ldr.n r0, [r1]")                                                  \
  X(pins_read_alone, 32, FW_PINS, "ldr.n r0, [r1]\n" FW_ADDS)
// clang-format on

FW_BUS_KERNELS(FW_KERNEL_CODE)

namespace fw::timing {
namespace {
constexpr Kernel kKernels[] = {FW_BUS_KERNELS(FW_KERNEL_ENTRY)};
}

std::span<const Kernel> bus_kernels() {
  return kKernels;
}

}  // namespace fw::timing

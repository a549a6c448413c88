// A micro-kernel: a few instructions, repeated in a straight line between two reads of the cycle counter.
//
//   Frame     r4, r5, r6: RAM, 256 bytes from one to the next; r7 = 0; r8: the counter's address. A body may
//             use r0 - r3, r10 - r12, lr and s0 - s15, and starts 16-byte aligned
//   Seams     two register moves on either side keep the counter's load from pairing with the body
//   Result    cycles of all repetitions and of the seams; the kernel `empty` has only the seams
//   Macros    an assembler needs its text as literals: one list of kernels makes both code and table
#pragma once
#include <cstdint>
#include <span>

namespace fw::timing {

using Code = std::uint32_t (*)(std::uint32_t* ram);

struct Kernel {
  const char* name;
  Code code;
  std::uint32_t iterations;
};

std::span<const Kernel> integer_kernels();
std::span<const Kernel> memory_kernels();
std::span<const Kernel> literal_kernels();
std::span<const Kernel> branch_kernels();
std::span<const Kernel> float_kernels();  // none on a part without an FPU
std::span<const Kernel> loop_kernels();   // the first is `empty`
std::span<const Kernel> bus_kernels();

}  // namespace fw::timing

// clang-format off
#define FW_KERNEL_HEAD(name)                                                                       \
  ".syntax unified\n.thumb\n.section .text.kernel_" name ",\"ax\",%progbits\n.balign 16\n"         \
  ".global kernel_" name "\n.type kernel_" name ", %function\nkernel_" name ":\n"                  \
  "push {r4-r11, lr}\n mov r4, r0\n add.w r5, r0, #256\n add.w r6, r0, #512\n movs r7, #0\n"       \
  "movw r8, #0x1004\n movt r8, #0xE000\n"  /* DWT_CYCCNT */
// 16 bytes from the load of the counter to the body.
#define FW_KERNEL_START                                                                            \
  ".balign 16\n ldr.w r9, [r8]\n mov r11, r11\n mov r11, r11\n nop.w\n nop.w\n"
#define FW_KERNEL_STOP(ending)                                                                     \
  "mov r11, r11\n mov r11, r11\n ldr.w r0, [r8]\n sub.w r0, r0, r9\n" ending                       \
  "\n pop {r4-r11, pc}\n.ltorg\n.section .text\n"

#define FW_KERNEL_CODE_ENDING(name, count, setup, body, ending)                                    \
  __asm(FW_KERNEL_HEAD(#name) setup "\n" FW_KERNEL_START ".rept " #count "\n" body "\n.endr\n"     \
        FW_KERNEL_STOP(ending));                                                                   \
  extern "C" std::uint32_t kernel_##name(std::uint32_t* ram);
#define FW_KERNEL_CODE(name, count, setup, body)                                                   \
  FW_KERNEL_CODE_ENDING(name, count, setup, body, "")
#define FW_KERNEL_ENTRY(name, count, setup, body) fw::timing::Kernel{#name, kernel_##name, count},
// clang-format on

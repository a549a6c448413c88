// Exceptions, timed: vector tables of their own in flash, since the core reads a vector and the handler's
// first instructions while it pushes registers to RAM; only so does entry take its 12 cycles.
#pragma once
#include <cstdint>
#include <span>

#include "firmware/timing/code_blocks.hpp"
#include "firmware/timing/kernel.hpp"

namespace fw::timing {

enum class Handlers : std::uint8_t {
  returning,  // all return at once
  pending,    // that of SVC pends PendSV, which is chained to its end
  switching,  // PendSV goes to the other process stack; r4 to r11 are saved by software
};

struct ExceptionKernel {
  Kernel kernel;
  Handlers handlers;
};

std::span<const ExceptionKernel> exception_kernels();
std::uint32_t run(const ExceptionKernel& kernel, std::uint32_t* ram);  // cycles, as of its code

// Runs `block` under SysTick interrupts, 1000 cycles apart, and counts those that came.
std::uint32_t cycles_with_systick(Block block, std::uint32_t& interrupts);

bool faults(Block block);  // the handler of the fault returns to the caller

}  // namespace fw::timing

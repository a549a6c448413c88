// Cycles of a Cortex-M3 or M4F for a straight run of instructions with zero wait states.
//
//   Source    M3: DDI 0337 chapter 18; M4: DDI 0439 chapter 3.3 (pairing of loads, write buffer) and
//             chapter 7 (FPU); where ARM gives a range, the head of core_model.cpp says what is taken
//   Unit      CPU cycles
//   Accuracy  taken as 10 % on compiled code: what the method showed against published benchmarks. No
//             board was at hand, so it is no bound
//   Divides   2 to 12 by operands: here 2, and the clock adds 1 and another for each four bits of the
//             quotient where it is not 0 (ARM: "early termination"; the steps are our reading of it)
//   Multiplies  long ones of the M3 take 3 to 5, with accumulation 4 to 6, signed 5 to 7: here the
//             least, and the clock adds 1 for each operand that does not fit 16 bits (our reading of
//             ARM's "depending on the size of the source values")
//   Addresses unaligned accesses and data in flash: the clock adds those too
//   Left out  costs that reach over the end of a basic block, DMA on the bus; an IT's skipped instructions cost as if
//             they were executed
#pragma once
#include <vector>

#include "io_bridges/qemu/cycles/instruction.hpp"

namespace whirl::cycles {

// Exceptions: 12 cycles to the handler's first instruction at zero wait states, 6 from one handler to
// the next, 10 back (../REFERENCES.md: KBA103489845; Yiu2013 for the 6).
constexpr double kException_entry = 12, kTail_chain = 6, kException_return = 10;
constexpr double kFloating_frame = 17;  // S0 to S15 and FPSCR: a word each

// What a taken branch adds to its own cycle: the pipeline refills.
double refill_cycles(const Instruction& i);

// Cycles of each instruction, given those before it in `run`. A branch that depends on a condition is
// counted as not taken; any other with its refill.
std::vector<double> core_cycles(Core core, const std::vector<Instruction>& run);

}  // namespace whirl::cycles

// Programs of random register accesses against a whole chip model, by seed.
//
//   A program  some hundred accesses to the blocks of a part: random offsets, widths and values (many
//              of them addresses of RAM and of other blocks, for DMA), time that passes, levels on
//              pins, watchdogs that bite, with and without the clocks set up
//   Good       it ends, no check of ours fails, and the events it caused are bounded by the time that
//              passed. A failed check throws or aborts, as base::set_check_handler says
//   Same seed  same program, same trace (trace() is a digest of all values read and lines raised)
#pragma once
#include <cstdint>
#include <string>

namespace whirl::stm32 {

struct FuzzOutcome {
  std::uint64_t trace = 0;
  std::uint64_t accesses = 0;
  std::uint64_t events = 0;  // fired
  std::string complaint;     // empty: good
};

// Even seeds run on an STM32F405, odd ones on an STM32F103.
FuzzOutcome fuzz_registers(std::uint64_t seed);

}  // namespace whirl::stm32

// What the memory that code lies in adds: wait states, prefetch, the line cache of the F405 (ART).
//
//   Source    RM0090 3.4.2 (ART: 64 lines of 128 bits, prefetch of the next line), PM0075 3.1 (F103:
//             two prefetch buffers of 64 bits); DDI 0337E 14.5.6: over the system bus, where SRAM is,
//             an M3 fetches a word every other cycle, never back to back
//   Method    a line arrives (wait states + 1) cycles after it was asked for; with prefetch the next
//             one is asked for as execution enters a line. A stall is what execution still waits for
//   ART       which lines it holds is known at run time only: `lines` says what would have to be
//             waited for. It is modelled as the last 64 lines fetched, oldest first out
//   Data      a literal is counted here where there is no data cache (DCEN); all else that is read from
//             flash where its address is known, at run time
//   Left out  fetches that wait for such data; the core's halt while flash is being programmed
#pragma once
#include <cstdint>
#include <vector>

#include "io_bridges/qemu/cycles/flash_timing.hpp"
#include "io_bridges/qemu/cycles/instruction.hpp"

namespace whirl::cycles {

constexpr int kCached_lines = 64, kCached_data_lines = 8;

struct LineUse {
  std::uint32_t line;  // address / line_bytes
  double cycles;       // to wait when it has to be fetched
};

struct Fetch {
  std::vector<double> stalls;  // of each instruction
  double entry = 0;            // more, when the run is reached by a taken branch
  // With a line cache: each counts when it is not held. The first one counts after a taken branch only.
  std::vector<LineUse> lines;
};

// Where code runs from: below 0x10000000 and from 0x08000000 flash, from 0x20000000 SRAM.
Fetch fetch_stalls(Core core, const FlashTiming& flash, const std::vector<Instruction>& run,
                   const std::vector<double>& cycles);

}  // namespace whirl::cycles

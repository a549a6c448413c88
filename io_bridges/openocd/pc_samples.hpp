// The share of time that a core sleeps or works, from samples of its program counter.
//
//   Idle      a sample in one of the idle spans: the WFI instructions of the image with what follows each, or a function
//             that the bench names
//   Interval  Wilson's, 95 %: of so many samples the share is known so well, if they are independent of what the
//             image does: who samples waits a random time between them, since the image's tasks are periodic
//   Unknown   0xFFFFFFFF (halted, or the part gives none) and what is in no function: counted apart
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace whirl::openocd {

struct IdleSpan {
  std::uint32_t from = 0, to = 0;  // [from, to)
};

struct BusyShare {
  std::size_t samples = 0, busy = 0, unknown = 0;  // unknown ones are in neither
  double share = 0.0, low = 0.0,
         high = 0.0;  // busy / samples, and its interval; NaN without samples
};

// [code_from, code_to) is where the image's code is.
BusyShare busy_share(std::span<const std::uint32_t> pcs, std::span<const IdleSpan> idle,
                     std::uint32_t code_from, std::uint32_t code_to);

// Spans of the WFI instructions (0xBF30) in code that is loaded at `address`, with the instruction behind each, where
// a core that has just woken may be seen. Data that looks so counts too.
std::vector<IdleSpan> waits_in(std::span<const std::uint8_t> code, std::uint32_t address);

}  // namespace whirl::openocd

// SPDX-License-Identifier: GPL-2.0-or-later
//
// What time it is in the middle of translated code, where QEMU's clock must not be read.
//
//   Method  each basic block adds its length to a counter in line, at its start; at every event,
//           exception and register access, where the clock is exact, clock and counter are taken
//           down together
#pragma once
#include <cstdint>

namespace whirl::qemu {

struct Timeline {
  std::uint64_t instructions = 0;  // written by translated code
  std::uint64_t anchor_instructions = 0;
  std::int64_t anchor_ns = 0;
  std::int64_t ns_per_instruction = 8;
  std::uint64_t ran_on = 0;  // check: anchors at which the two disagreed while nothing slept

  void anchor(std::int64_t now_ns) {
    anchor_ns = now_ns;
    anchor_instructions = instructions;
  }
  // Before the instruction that has `behind` instructions of its block from itself to the end.
  std::int64_t at(std::uint64_t behind) const {
    return anchor_ns + static_cast<std::int64_t>(instructions - behind - anchor_instructions) *
                           ns_per_instruction;
  }
};

}  // namespace whirl::qemu

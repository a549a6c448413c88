// SPDX-License-Identifier: GPL-2.0-or-later
//
// What a load or store costs by its address, which is known at run time only. All without a branch:
// a branch ends the life of what the translator keeps in host registers.
//
//   Flash     data comes through a cache of 8 lines of 128 bits on the F405 (RM0090 3.4.2), taken as
//             the last 8 lines fetched, oldest first out; without a cache each read waits
//   Unaligned a half-word goes as two bytes, one cycle more; a word as two half-words, one more, or as a
//             byte, a half-word and a byte, two more (DDI 0439 3.3.2, DDI 0337 the like)
//   Place     ahead of the access: one that turns out to reach a register is done again, but costs
//             nothing here
#pragma once
#include <cstdint>

#include "io_bridges/qemu/plugin/tcg.hpp"

namespace whirl::qemu {

// Which lines of flash a cache holds, as the number of the fill that brought each.
struct FlashLines {
  static constexpr std::uint32_t kLines = 65536;  // of 1 MiB of flash, 16 bytes each
  std::int64_t held = 0;                          // so many fills later a line is gone
  std::int64_t fills = 0;
  std::int64_t filled[kLines];

  explicit FlashLines(std::int64_t held_lines) : held(held_lines) { forget(); }
  void forget();
};

// All bits when the line whose fill is kept at `where` (of `lines`) is not held, else 0; it is then
// counted as fetched. Only where `when` has all bits; 0: always.
tcg::Argument missed_line(tcg::Ahead& ahead, FlashLines& lines, tcg::Argument where,
                          tcg::Argument when);

// What a read of data waits for: `wait` when it is of flash, with a cache when it misses.
tcg::Argument flash_wait(tcg::Ahead& ahead, FlashLines* cache, tcg::Argument address,
                         std::int64_t wait);

// Cycles more of a load or store (an operation that accesses the guest's memory) that is not aligned.
tcg::Argument unaligned_cycles(tcg::Ahead& ahead, const tcg::Operation& access);

}  // namespace whirl::qemu

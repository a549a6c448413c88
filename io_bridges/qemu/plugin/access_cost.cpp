// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/access_cost.hpp"

#include <algorithm>

namespace whirl::qemu {

using tcg::Ahead;
using tcg::Argument;
using tcg::number32;
using tcg::number64;

void FlashLines::forget() {
  std::fill(std::begin(filled), std::end(filled), fills - held);
}

Argument missed_line(Ahead& ahead, FlashLines& lines, Argument where, Argument when) {
  const tcg::Numbers& op = tcg::numbers();
  const Argument count = tcg::address(&lines.fills);
  const Argument then = ahead.op64(op.ld64, where), now = ahead.op64(op.ld64, count);
  const Argument age = ahead.op64(op.sub64, now, then);
  const Argument spare = ahead.op64(op.sub64, number64(lines.held - 1), age);
  Argument missed = ahead.op64(op.sar64, spare, number64(63));
  if (when != 0) missed = ahead.op64(op.and64, missed, when);
  const Argument next = ahead.op64(op.sub64, now, missed);
  ahead.put(op.st64, next, count);
  const Argument change = ahead.op64(op.and64, missed, ahead.op64(op.sub64, next, then));
  ahead.put(op.st64, ahead.op64(op.add64, then, change), where);
  return missed;
}

// Flash, and its alias at 0, are all that lies below 0x10000000. What is elsewhere looks at line 0.
Argument flash_wait(Ahead& ahead, FlashLines* cache, Argument address, std::int64_t wait) {
  const tcg::Numbers& op = tcg::numbers();
  const Argument top = ahead.op32(op.shr32, address, number32(28));
  const Argument below = ahead.op64(op.sub64, ahead.op64(op.widen_unsigned, top), number64(1));
  const Argument in_flash = ahead.op64(op.sar64, below, number64(63));
  if (cache == nullptr) return ahead.op64(op.and64, in_flash, number64(wait));
  const Argument line = ahead.op32(op.shr32, address, number32(4));
  const Argument number =
      ahead.op32(op.and32, line, number32(static_cast<std::int32_t>(FlashLines::kLines - 1)));
  const Argument offset = ahead.op64(op.shl64, ahead.op64(op.widen_unsigned, number), number64(3));
  const Argument where =
      ahead.op64(op.add64, ahead.op64(op.and64, offset, in_flash), tcg::address(&cache->filled[0]));
  const Argument missed = missed_line(ahead, *cache, where, in_flash);
  return ahead.op64(op.and64, missed, number64(wait));
}

// A table of two bits for each place within a word.
Argument unaligned_cycles(Ahead& ahead, const tcg::Operation& access) {
  constexpr std::int32_t kHalf_word = 0b01'00'01'00, kWord = 0b10'01'10'00;
  const tcg::Numbers& op = tcg::numbers();
  const int bytes_log2 = tcg::size_log2(access);
  if (bytes_log2 == 0) return number64(0);
  const Argument place = ahead.op32(op.and32, access.arguments[1], number32(3));
  const Argument table = number32(bytes_log2 == 1 ? kHalf_word : kWord);
  const Argument entry = ahead.op32(op.shr32, table, ahead.op32(op.shl32, place, number32(1)));
  return ahead.op64(op.widen, ahead.op32(op.and32, entry, number32(3)));
}

}  // namespace whirl::qemu

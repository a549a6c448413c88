// A part that does not exist, for tests of the virtual board itself: a core with memories and one
// register block at 0x40000000 (IRQ 31), whose every access has an exact time.
//
//   0x00 TIME   r   virtual nanoseconds, low word           0x04 TIMEH r  high word
//   0x08 TIMER  w   interrupt after so many ns (0: stop)    0x0C EVERY w  and then every so many ns
//   0x10 ACK    w   lowers the line                          0x14 DIGEST rw  each write: folds the
//                                                            value and the time of the write in
//   0x18 SAY    w   a finding "says 0x..." at that time      0x1C RESET w  resets by that cause
//   0x20 FLASHCR rw 1: stores into flash program it          0x24 ERASE w  erases 16 KiB at address
//   0x28 CAUSE  r   of the last reset                        0x2C TICKS r  interrupts raised so far
//   0x30 BUG    w   of ours, on purpose: 1 a failed check, 2 out of memory, 3 abort(), 4 an exception,
//                   5 events for ever at one instant
#pragma once
#include <memory>

#include "io_bridges/qemu/stm32/chip_model.hpp"

namespace whirl::board {

std::unique_ptr<stm32::ChipModel> make_bench_chip(const stm32::ChipHost& host);

}  // namespace whirl::board

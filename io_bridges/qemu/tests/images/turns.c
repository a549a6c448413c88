/* Turns of one loop, each with a store that sets a deadline far off, behind a literal: tells by how many cycles
   the longest is longer than the shortest. */
#include "bench.h"

#define CYCCNT REG(0xE0001004)

int main(void) {
  REG(0xE000EDFC) |= 1u << 24;
  CYCCNT = 0;
  REG(0xE0001000) |= 1;
  uint32_t least = 0xFFFFFFFF, most = 0, last = 0;
  for (int n = 0; n < 20000; ++n) {
    __asm volatile("ldr r0, =0x12345678\n" ::: "r0");
    TIMER = 200000;
    (void)TIME;
    const uint32_t now = CYCCNT;
    if (n > 2 && now - last < least) least = now - last;
    if (n > 2 && now - last > most) most = now - last;
    last = now;
  }
  SAY = most - least;
  for (;;) __asm volatile("wfi");
}

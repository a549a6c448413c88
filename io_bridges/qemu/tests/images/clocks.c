/* Compares the time of events with the core's cycles, by two loads one behind the other: tells by how much
   their difference has varied, in 21sts of a nanosecond (21 cycles are 125 ns). HOW 1: far from all that is
   due, which is the harness's turn at each millisecond; 2: among deadlines that reach no one. */
#include "bench.h"

#define CYCCNT REG(0xE0001004)

static volatile uint32_t word;

static uint32_t time_ns;
static inline __attribute__((always_inline)) int32_t difference(void) {
  uint32_t cycles;
  /* What a block costs behind its first load is owed by the time that the next one is reached. */
  __asm volatile("ldr %0, [%4]\n .rept 12\n nop\n .endr\n ldr %0, [%2]\n ldr %1, [%3]\n"
                 : "=&r"(time_ns), "=&r"(cycles)
                 : "r"(&TIME), "r"(&CYCCNT), "r"(&word)
                 : "memory");
  return (int32_t)(time_ns * 21u - cycles * 125u);
}

static int nothing_is_due(void) {
#if HOW == 1
  const uint32_t in_turn_ns = time_ns % 1000000;
  return in_turn_ns > 500 && in_turn_ns < 999500;
#else
  return 1;
#endif
}

int main(void) {
  REG(0xE000EDFC) |= 1u << 24;
  CYCCNT = 0;
  REG(0xE0001000) |= 1;
#if HOW == 2
  EVERY = 131;
#endif
  const int32_t first = difference();
  int32_t least = 0, most = 0;
  for (int n = 0; n < 60000; ++n) {
    const int32_t now = difference() - first;
    if (nothing_is_due()) {
      if (now < least) least = now;
      if (now > most) most = now;
    }
    /* A literal's quarter of a cycle, and what IT folds. */
    __asm volatile(
        "ldr r0, =0x12345678\n cmp r0, %0\n ite eq\n addeq r1, r0, #1\n addne r1, r0, #2\n" ::"r"(n)
        : "r0", "r1", "cc");
    if (n % 3 == 0) word += (uint32_t)n;
  }
  SAY = (uint32_t)(most - least);
  for (;;) __asm volatile("wfi");
}

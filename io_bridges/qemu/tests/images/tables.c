/* Reads a thousand words here and there, from RAM and from flash, with wait states: tells how many cycles
   each walk took. The clock is HSI, at which any number of wait states will do. */
#include "part.h"

#ifdef F4
#define CLOCK 16000000u
#define CACHED 0x705u   /* 5 wait states, prefetch, both caches */
#define UNCACHED 0x305u /* without the cache of data */
#else
#define CLOCK 8000000u
#define CACHED 0x12u /* 2 wait states, prefetch: there is no cache */
#endif
#define READS 1000
#define RAM 0x20000400u
#define TABLE 0x08008000u /* erased flash will do */

/* `step` bytes on each time, round and round within `size` (a power of two). The loop lies in 16 bytes. */
static uint32_t walk(uint32_t from, uint32_t step, uint32_t size) {
  uint32_t begun, ended, at = 0, left = READS;
  __asm volatile(
      ".balign 16\n ldr %0, [%4]\n b 2f\n .balign 16\n"
      "2: ldr r3, [%5, %2]\n add %2, %2, %6\n and %2, %2, %7\n subs %3, %3, #1\n bne 2b\n"
      "ldr %1, [%4]"
      : "=&r"(begun), "=&r"(ended), "+r"(at), "+r"(left)
      : "r"(&CYCCNT), "r"(from), "r"(step), "r"(size - 1)
      : "r3", "cc", "memory");
  return ended - begun;
}

/* One line more than a data cache of 8 holds: round and round in a window that is no power of two. */
static uint32_t round_of(uint32_t from, uint32_t lines) {
  uint32_t begun = CYCCNT;
  for (uint32_t n = 0; n < READS / lines; ++n) {
    for (uint32_t line = 0; line < lines; ++line) (void)REG(from + 16 * line);
  }
  return CYCCNT - begun;
}

static uint32_t four_at_once(uint32_t from) {
  uint32_t begun = CYCCNT;
  for (uint32_t n = 0; n < READS / 4; ++n) {
    __asm volatile("ldm %0, {r1, r2, r3, r4}" ::"r"(from + 16 * n) : "r1", "r2", "r3", "r4");
  }
  return CYCCNT - begun;
}

static void tell(uint32_t from) {
  say(walk(from, 0, 4096));  /* the same word */
  say(walk(from, 4, 4096));  /* word by word */
  say(walk(from, 64, 4096)); /* a line of its own each time */
  say(round_of(from, 8));
  say(round_of(from, 10));
  say(four_at_once(from));
}

int main(void) {
  open_terminal((CLOCK + 57600) / 115200);
  DEMCR |= 1u << 24;
  DWT_CTRL |= 1;
  FLASH_ACR = CACHED;
  tell(RAM);
  tell(TABLE);
#ifdef UNCACHED
  FLASH_ACR = UNCACHED;
  tell(RAM);
  tell(TABLE);
#endif
  for (;;) __asm volatile("wfi");
}

/* Counts cycles by DWT CYCCNT, HOW by HOW, and says each count. */
#include "bench.h"

#define CYCCNT REG(0xE0001004)
#define SYST_CSR REG(0xE000E010)
#define SYST_RVR REG(0xE000E014)
#define SYST_CVR REG(0xE000E018)

static volatile uint32_t word;
static volatile uint32_t ticks, first_tick;

static void start_counter(void) {
  REG(0xE000EDFC) |= 1u << 24;
  CYCCNT = 0;
  REG(0xE0001000) |= 1;
}

#define COUNTED(code)                                                     \
  ({                                                                      \
    uint32_t from_, to_;                                                  \
    __asm volatile(".balign 16\n ldr %0, [%2]\n" code "\n ldr %1, [%2]\n" \
                   : "=&r"(from_), "=&r"(to_)                             \
                   : "r"(0xE0001004), "r"(&word), "r"(&CYCCNT)            \
                   : "r0", "r1", "r2", "r12", "cc", "memory");            \
    to_ - from_;                                                          \
  })
#define LOOP(body) "mov r0, #1000\n 1: " body "\n subs r0, r0, #1\n bne 1b"

#if HOW == 1 /* straight code, loops, memory and registers */
int main(void) {
  start_counter();
  SAY = COUNTED("");
  SAY = COUNTED("nop");
  SAY = COUNTED(".rept 100\n nop\n .endr");
  SAY = COUNTED(LOOP("nop"));
  SAY = COUNTED(LOOP("ldr r1, [%3]"));
  SAY = COUNTED(LOOP("ldr r1, [%4]"));
  SAY = COUNTED("mov r0, #3\n cmp r0, #3\n ite eq\n addeq r1, r0, #1\n addne r1, r0, #2\n nop");
  SAY = COUNTED("mov r0, #5\n mov r1, #50\n udiv r2, r1, r0");
  for (;;) __asm volatile("wfi");
}
#elif HOW == 8 /* divisions, against a long one */
static uint32_t divided(uint32_t a, uint32_t b) {
  uint32_t quotient = 0, rest = 0;
  for (int bit = 31; bit >= 0; --bit) {
    rest = rest << 1 | ((a >> bit) & 1);
    if (rest >= b) {
      rest -= b;
      quotient |= 1u << bit;
    }
  }
  return quotient;
}

int main(void) {
  uint32_t a = 1, b = 1, wrong = 0;
  start_counter();
  for (int i = 0; i < 2000; ++i) {
    a = a * 1664525u + 1013904223u;
    b = ((b * 22695477u + 1u) >> (i & 15)) | 1u;
    const int32_t by_sign = (int32_t)a / (int32_t)(b >> 1 | 1);
    const uint32_t magnitude = a >> 31 ? 0u - a : a;
    const uint32_t expected = divided(magnitude, b >> 1 | 1);
    wrong += a / b != divided(a, b);
    wrong += by_sign != (int32_t)(a >> 31 ? 0u - expected : expected);
    if (i % 7 == 0 && a % b != a - b * divided(a, b)) ++wrong;
  }
  SAY = wrong;
  for (;;) __asm volatile("wfi");
}
#else          /* the time between ticks, as the handler's first load sees it */
void systick_handler(void) {
  const uint32_t now = CYCCNT;
  if (ticks++ > 0) SAY = now - first_tick;
  first_tick = now;
}

int main(void) {
  ticks = 0;
  start_counter();
  SYST_RVR = 16800 - 1;
  SYST_CVR = 0;
  SYST_CSR = 7;
#if HOW == 7   /* deadlines without an interrupt: they cut the code below everywhere */
  EVERY = 131;
  TIMER = 131;
#endif
  for (;;) {
#if HOW == 2
    __asm volatile(".rept 150\n nop\n .endr");
#elif HOW == 3
    __asm volatile("mov r0, #3\n .rept 20\n udiv r1, r0, r0\n .endr" ::: "r0", "r1");
#elif HOW == 4
    __asm volatile("wfi");
#elif HOW == 5
    __asm volatile("ldr r0, =0x20000100\n .rept 20\n ldmia r0, {r1-r8}\n .endr" ::
                       : "r0", "r1", "r2", "r3", "r4", "r5", "r6", "r7", "r8");
#elif HOW == 6
    for (volatile int i = 0; i < 100; ++i) word += TIME;
#elif HOW == 7 /* IT blocks, whose conditions must outlive any interrupt */
    uint32_t sum = 0;
    __asm volatile(
        ".rept 40\n cmp %0, #40\n itee eq\n addeq %0, %0, #100\n addne %0, %0, #1\n nopne\n .endr"
        : "+r"(sum)::"cc");
    if (sum != 40) SAY = 0xBAD0000 | sum;
#endif
  }
}
#endif

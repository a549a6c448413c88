/* For a debugger to step through: says how many cycles counted() took, again and again. */
#include "bench.h"

#define CYCCNT REG(0xE0001004)
static volatile uint32_t words[4];

__attribute__((noinline)) uint32_t counted(uint32_t n) {
  uint32_t sum = 0;
  for (uint32_t k = 0; k < n; ++k) {
    words[k & 3] = sum;
    sum += words[(k + 1) & 3] * k + 0x12345678u / (k + 1);
  }
  return sum;
}

int main(void) {
  REG(0xE000EDFC) |= 1u << 24;
  REG(0xE0001000) |= 1;
  for (int n = 0; n < 5; ++n) {
    const uint32_t from = CYCCNT;
    (void)counted(20);
    SAY = CYCCNT - from;
  }
  for (;;) __asm volatile("wfi");
}

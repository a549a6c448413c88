/* Touches registers that nobody models. */
#include "bench.h"

__attribute__((noinline)) void poke(void) {
  REG(0x40007C00) = 1;
  REG(0x40007C00) = 2;
}

int main(void) {
  poke();
  SAY = REG(0x50001234);
  for (;;) __asm volatile("wfi");
}

/* Interrupts are held off for a counted time while the timer's request waits. */
#include "bench.h"

void irq31_handler(void) {
  ACK = 0;
}

/* The timer fires 800 ns after its store; 1 + 2 x 100 + 1 instructions of 8 ns follow. */
__attribute__((naked, noinline)) static void hold(volatile uint32_t* timer, uint32_t in_ns) {
  __asm volatile(
      "cpsid i\n"
      "str r1, [r0]\n"
      "movs r2, #100\n"
      "1: subs r2, #1\n"
      "bne 1b\n"
      "cpsie i\n"
      "bx lr\n");
  (void)timer;
  (void)in_ns;
}

int main(void) {
  ISER0 = 1u << 31;
  hold(&TIMER, 800);
  for (;;) __asm volatile("wfi");
}

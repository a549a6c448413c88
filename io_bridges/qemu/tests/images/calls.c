/* Functions whose length is known by counting: 1 + 2 x 100 + 1 instructions. */
#include "bench.h"

__attribute__((naked, noinline)) void counted(void) {
  __asm volatile(
      "movs r0, #100\n"
      "1: subs r0, #1\n"
      "bne 1b\n"
      "bx lr\n");
}
__attribute__((naked, noinline)) void tail(void) {
  __asm volatile("b counted\n");
}
__attribute__((naked, noinline)) void conditional(void) {
  __asm volatile(
      "movs r0, #1\n"
      "cmp r0, #0\n"
      "it eq\n"
      "bxeq lr\n" /* not taken */
      "bx lr\n");
}
__attribute__((naked, noinline)) void nested(void) {
  __asm volatile(
      "push {r4, lr}\n"
      "bl counted\n"
      "bl counted\n"
      "pop {r4, pc}\n");
}

void irq31_handler(void) {
  ACK = 0;
}

int main(void) {
  counted();
  tail();
  conditional();
  nested();
  void (*volatile indirect)(void) = counted;
  indirect();
  ISER0 = 1u << 31;
  TIMER = 400; /* an interrupt in the middle of the next call */
  counted();
  for (;;) __asm volatile("wfi");
}

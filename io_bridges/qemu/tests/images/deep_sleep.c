/* Sleeps deeply, as for Stop, and asks to go back to sleep behind each handler. Says SCR as it reads it. */
#include "bench.h"

#define SCR REG(0xE000ED10)

int main(void) {
  SCR = 1u << 2;
  SAY = SCR;
  for (int i = 0; i < 3; ++i) {
    TIMER = 1000;
    ISER0 = 1u << 31;
    __asm volatile("wfi");
  }
  SCR = 1u << 1 | 0xFFFFFF00u;
  SAY = SCR;
  for (;;) __asm volatile("wfi");
}

void irq31_handler(void) {
  ACK = 0;
}

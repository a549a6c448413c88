/* Programs a word of flash, resets by software, looks at it, erases it, is reset by a watchdog, looks
   again: says what it finds at each start. */
#include "bench.h"

#define CELL REG(0x08040000)

int main(void) {
  SAY = CELL;
  SAY = CAUSE;
  FLASHCR = 1;
  if (CAUSE == 0) {
    CELL = 0x12345678;
    CELL = 0xFFFF00FF; /* programming clears bits only */
    AIRCR = 0x05FA0004;
  } else if (CAUSE == 2) {
    ERASE = 0x08040000;
    RESET_BY = 3;
  }
  for (;;) __asm volatile("wfi");
}

/* Writes to TIM2's ARR through its bit-band alias and beside it, alone and one after another, from HSI without
   dividers: tells the cycles of a hundred of each, and last whether the bits arrived. */
#include "part.h"

#ifdef F4
#define CLOCK 16000000u
#define TIM2_ON REG(RCC + 0x40) |= 1
#else
#define CLOCK 8000000u
#define TIM2_ON REG(RCC + 0x1C) |= 1
#endif
#define ARR 0x4000002Cu
#define ALIAS(bit) REG(0x42000000u + (ARR - 0x40000000u) * 32 + (bit)*4)
#define PAUSE __asm volatile(".rept 12\n nop\n .endr")
#define HUNDRED(code)               \
  ({                                \
    const uint32_t from = CYCCNT;   \
    for (int n = 0; n < 100; ++n) { \
      code;                         \
    }                               \
    CYCCNT - from;                  \
  })

int main(void) {
  open_terminal((CLOCK + 57600) / 115200);
  TIM2_ON;
  DEMCR |= 1u << 24;
  DWT_CTRL |= 1;
  FLASH_ACR &= ~7u;
  REG(ARR) = 0;
  const uint32_t pauses = HUNDRED(PAUSE);
  say(HUNDRED(REG(ARR) = 5; PAUSE) - pauses);
  say(HUNDRED(ALIAS(3) = 1; PAUSE) - pauses);
  say(HUNDRED((void)REG(ARR); PAUSE) - pauses);
  say(HUNDRED((void)ALIAS(3); PAUSE) - pauses);
  say(HUNDRED(ALIAS(4) = 1; ALIAS(5) = 1; PAUSE; PAUSE) - 2 * pauses);
  say(REG(ARR));
  for (;;) __asm volatile("wfi");
}

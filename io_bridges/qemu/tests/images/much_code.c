/* More code than a small buffer of the emulator's holds translated, full of writes to a register: tells how
   many cycles each round through it took. Each piece is 30 bytes, so that they lie in the lines of flash (16)
   in eight ways; what is ahead of a write takes longer than a line is fetched. */
#include "part.h"

#define WAITS 0x705u /* 5 wait states, prefetch, both caches */
#define CLOCK 16000000u
#define GPIO_BSRR 0x40020018u
#define ROUNDS 12

/* Sets and clears none of the pins. */
__attribute__((naked, noinline)) static void go_through(uint32_t bsrr __attribute__((unused))) {
  __asm volatile(
      ".rept 600\n movs r3, #0\n .rept 8\n nop\n .endr\n str.w r3, [r0]\n"
      "adds r3, #1\n nop\n b 1f\n nop\n 1:\n .endr\n bx lr");
}

static uint32_t round_through(void) {
  uint32_t begun = CYCCNT;
  go_through(GPIO_BSRR);
  return CYCCNT - begun;
}

int main(void) {
  open_terminal((CLOCK + 57600) / 115200);
  DEMCR |= 1u << 24;
  DWT_CTRL |= 1;
  FLASH_ACR = WAITS;
  for (int n = 0; n < ROUNDS; ++n) say(round_through());
  for (;;) __asm volatile("wfi");
}

/* A start-up in the way of ST's system_stm32f4xx.c and system_stm32f10x.c: the crystal gets a counted
   loop, and when it is not ready by then nothing is said and the core stays on HSI. */
#include <stdint.h>

#define REG(a) (*(volatile uint32_t*)(a))
#ifdef F4
#define RCC 0x40023800u
#define ACR REG(0x40023C00u)
#define CFGR REG(RCC + 8)
#define HSE_STARTUP_TIMEOUT 0x5000
#else
#define RCC 0x40021000u
#define ACR REG(0x40022000u)
#define CFGR REG(RCC + 4)
#define HSE_STARTUP_TIMEOUT 0x500
#endif
#define CR REG(RCC)

static void set_clock(void) {
  volatile uint32_t counter = 0, status = 0;
  CR |= 1u << 16;
  do {
    status = CR & (1u << 17);
    counter++;
  } while (status == 0 && counter != HSE_STARTUP_TIMEOUT);
  if ((CR & (1u << 17)) == 0) return;
#ifdef F4
  CFGR |= (5u << 10) | (4u << 13);
  REG(RCC + 4) = 8u | (336u << 6) | (1u << 22) | (7u << 24);
  CR |= 1u << 24;
  while ((CR & (1u << 25)) == 0) {
  }
  ACR = 0x705;
#else
  ACR = 0x12;
  CFGR |= (4u << 8) | (1u << 16) | (7u << 18);
  CR |= 1u << 24;
  while ((CR & (1u << 25)) == 0) {
  }
#endif
  CFGR |= 2u;
  while ((CFGR & 0xCu) != 8u) {
  }
}

void reset_handler(void) {
  set_clock();
  for (;;) {
  }
}

__attribute__((section(".vectors"), used)) void (*const vectors[2])(void) = {
    (void (*)(void))0x20005000u, reset_handler};

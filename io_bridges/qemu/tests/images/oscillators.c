/* A tick each millisecond, as the oscillator counts it: HSI, or the crystal of 8 MHz (-DCRYSTAL). Each
   tells on the terminal how many cycles have gone by since the one before. */
#include "part.h"

#if defined(F4) && !defined(CRYSTAL)
#define CLOCK 16000000u
#else
#define CLOCK 8000000u
#endif

void systick_handler(void) {
  COUNT(1) = CYCCNT;
  ++COUNT(0);
}

int main(void) {
#ifdef CRYSTAL
  RCC_CR |= HSEON;
  while ((RCC_CR & HSERDY) == 0) {
  }
  RCC_CFGR |= 1;
  while ((RCC_CFGR & 0xC) != 4) {
  }
#endif
  open_terminal((CLOCK + 57600) / 115200);
  COUNT(0) = 0;
  DEMCR |= 1u << 24;
  DWT_CTRL |= 1;
  SYST_RVR = CLOCK / 1000 - 1;
  SYST_CVR = 0;
  SYST_CSR = 7;
  for (uint32_t told = 0, last = 0;;) {
    while (COUNT(0) == told) __asm volatile("wfi");
    ++told;
    if (told > 1) say(COUNT(1) - last);
    last = COUNT(1);
  }
}

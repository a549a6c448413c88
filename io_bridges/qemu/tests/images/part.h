/* For test images that run on both parts (-DF1, -DF4): the registers with which a part gets going. */
#pragma once
#include "bench.h"

#ifdef F4
#define RCC 0x40023800u
#define RCC_CFGR REG(RCC + 8)
#define FLASH_ACR REG(0x40023C00u)
#define USART 0x40004400u
#else
#define RCC 0x40021000u
#define RCC_CFGR REG(RCC + 4)
#define FLASH_ACR REG(0x40022000u)
#define USART 0x40013800u
#endif
#define RCC_CR REG(RCC)
#define HSEON (1u << 16)
#define HSERDY (1u << 17)
#define PLLON (1u << 24)
#define PLLRDY (1u << 25)

#define SYST_CSR REG(0xE000E010)
#define SYST_RVR REG(0xE000E014)
#define SYST_CVR REG(0xE000E018)
#define DWT_CTRL REG(0xE0001000)
#define CYCCNT REG(0xE0001004)
#define DEMCR REG(0xE000EDFC)
#define COUNT(n) REG(0x20000100 + 4 * (n)) /* variables: both parts have SRAM here */

/* PA2 of the STM32F405 (USART2), PA9 of the STM32F103 (USART1). */
static inline void open_terminal(uint32_t divisor) {
#ifdef F4
  REG(RCC + 0x30) |= 1;
  REG(RCC + 0x40) |= 1u << 17;
  REG(0x40020020) = 7u << 8;
  REG(0x40020000) |= 2u << 4;
#else
  REG(RCC + 0x18) |= 1u << 2 | 1u << 14;
  REG(0x40010804) = (REG(0x40010804) & ~0xF0u) | 0xB0;
#endif
  REG(USART + 8) = divisor;
  REG(USART + 12) = 0x2008;
}

static inline void send(char c) {
  while ((REG(USART) & 0x80) == 0) {
  }
  REG(USART + 4) = (uint32_t)c;
}

static inline void say(uint32_t value) {
  char digits[10];
  int n = 0;
  do {
    digits[n++] = (char)('0' + value % 10);
    value /= 10;
  } while (value != 0);
  while (n > 0) send(digits[--n]);
  send('\n');
}

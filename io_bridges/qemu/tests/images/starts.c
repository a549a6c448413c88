/* From reset to the part's full clock by a crystal of 8 MHz, STYLE by STYLE, then delays as C libraries
   make them. The stand takes the time of each by watching mark_...(): it trusts no counter in here.
   1 libopencm3: waits for every flag, for ever, HSI first
   2 ChibiOS: the register at once, HSI, then the crystal, the flash just before the switch
   3 HAL: waits with a time-out by a tick of SysTick, which changes its clock under way
   4 CMSIS: waits with a time-out by DWT's counter */
#include "part.h"

#ifdef F4
#define FULL 168u
#define RESET_CLOCK 16u
#define DIVIDERS (5u << 10 | 4u << 13)
#define SET_PLL() (REG(RCC + 4) = 8u | 336u << 6 | 1u << 22 | 7u << 24)
#define WAIT_STATES 0x705u
#else
#define FULL 72u
#define RESET_CLOCK 8u
#define DIVIDERS (4u << 8)
#define SET_PLL() (RCC_CFGR |= 1u << 16 | 7u << 18)
#define WAIT_STATES 0x12u
#endif
#define TICKS COUNT(0)

#define MARK(name)                                  \
  __attribute__((noinline)) void mark_##name(void); \
  void mark_##name(void) {                          \
    __asm volatile("" ::: "memory");                \
  }
MARK(ready)
MARK(loop_end)
MARK(dwt_end)
MARK(systick_end)
MARK(tick_end)
MARK(given_up)

void systick_handler(void) {
  ++TICKS;
}

static inline void tick_each_millisecond(uint32_t clock_MHz) {
  SYST_RVR = clock_MHz * 1000 - 1;
  SYST_CVR = 0;
  SYST_CSR = 7;
}

static inline void start_counter(void) {
  DEMCR |= 1u << 24;
  CYCCNT = 0;
  DWT_CTRL |= 1;
}

#if STYLE < 3
static inline void await(volatile uint32_t* reg, uint32_t mask, uint32_t want) {
  while ((*reg & mask) != want) {
  }
}
#elif STYLE == 3
static void await(volatile uint32_t* reg, uint32_t mask, uint32_t want) {
  const uint32_t start = TICKS;
  while ((*reg & mask) != want) {
    if (TICKS - start > 100) mark_given_up();
  }
}
#else
static void await(volatile uint32_t* reg, uint32_t mask, uint32_t want) {
  const uint32_t start = CYCCNT;
  while ((*reg & mask) != want) {
    if (CYCCNT - start > 5000 * RESET_CLOCK) mark_given_up(); /* 5 ms */
  }
}
#endif

static void start_clocks(void) {
#if STYLE == 1
  RCC_CR |= 1;
  await(&RCC_CR, 2, 2);
  RCC_CFGR &= ~3u;
  await(&RCC_CFGR, 0xC, 0);
  RCC_CR |= HSEON;
  await(&RCC_CR, HSERDY, HSERDY);
  RCC_CFGR |= DIVIDERS;
  FLASH_ACR = WAIT_STATES;
  SET_PLL();
  RCC_CR |= PLLON;
#elif STYLE == 2
  RCC_CR |= 1;
  await(&RCC_CR, 2, 2);
  RCC_CR = (RCC_CR & 0xF8) | 1;
  RCC_CFGR = 0;
  await(&RCC_CFGR, 0xC, 0);
  RCC_CR |= HSEON;
  await(&RCC_CR, HSERDY, HSERDY);
  RCC_CFGR = DIVIDERS;
  SET_PLL();
  RCC_CR |= PLLON;
  await(&RCC_CR, PLLRDY, PLLRDY);
  FLASH_ACR = WAIT_STATES;
#else
#if STYLE == 3
  TICKS = 0;
  tick_each_millisecond(RESET_CLOCK);
#else
  start_counter();
#endif
  RCC_CR |= HSEON;
  await(&RCC_CR, HSERDY, HSERDY);
  RCC_CR &= ~PLLON;
  await(&RCC_CR, PLLRDY, 0);
  SET_PLL();
  RCC_CR |= PLLON;
  await(&RCC_CR, PLLRDY, PLLRDY);
  FLASH_ACR = WAIT_STATES;
  RCC_CFGR |= DIVIDERS;
#endif
  await(&RCC_CR, PLLRDY, PLLRDY);
  RCC_CFGR = (RCC_CFGR & ~3u) | 2;
  await(&RCC_CFGR, 0xC, 8);
#if STYLE == 3
  tick_each_millisecond(FULL);
#endif
}

int main(void) {
  start_clocks();
  mark_ready();
  /* Counted, as in boot loaders and start-up code: two instructions a turn. */
  __asm volatile(".balign 16\n 1: subs %0, %0, #1\n bne 1b" ::"r"(100000) : "cc");
  mark_loop_end();
  start_counter();
  const uint32_t from = CYCCNT;
  while (CYCCNT - from < 1000 * FULL) {
  }
  mark_dwt_end();
  SYST_CSR = 0;
  SYST_RVR = 1000 * FULL - 1;
  SYST_CVR = 0;
  SYST_CSR = 5;
  while ((SYST_CSR & 1u << 16) == 0) {
  }
  mark_systick_end();
  tick_each_millisecond(FULL);
  TICKS = 0;
  while (TICKS < 5) {
  }
  mark_tick_end();
  for (;;) __asm volatile("wfi");
}

/* Cycles of two thousand loads from a register behind APB1 while DMA2 moves nothing, TIM2's count, TIM1's and a
   word that no register answers; behind each what DMA has left of its 20,000 words. */
#include "part.h"

#define LIFCR REG(0x40026408)
#define STREAM(offset) REG(0x40026410 + (offset))
#define TIM2_ARR REG(0x4000002C)

static void move(uint32_t from) {
  LIFCR = 0x3D;
  STREAM(0x04) = 20000;
  STREAM(0x08) = from;
  STREAM(0x0C) = 0x20000800;
  STREAM(0x14) = 1u << 2 | 3;
  STREAM(0x00) = 2u << 6 | 2u << 11 | 2u << 13;
  STREAM(0x00) |= 1;
}

static __attribute__((noinline)) void count(uint32_t from) {
  if (from != 0) move(from);
  const uint32_t start = CYCCNT;
  for (int n = 0; n < 2000; ++n) (void)TIM2_ARR;
  const uint32_t took = CYCCNT - start, left = STREAM(0x04);
  STREAM(0x00) = 0;
  while ((STREAM(0x00) & 1) != 0) {
  }
  say(took);
  say(left);
}

int main(void) {
  open_terminal((16000000u + 57600) / 115200);
  REG(RCC + 0x30) |= 1u << 22;
  REG(RCC + 0x40) |= 1;
  REG(RCC + 0x44) |= 1;
  DEMCR |= 1u << 24;
  DWT_CTRL |= 1;
  count(0);
  count(0x40000024);
  count(0x40010024);
  count(0x40007C00);
  for (;;) __asm volatile("wfi");
}

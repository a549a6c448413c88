/* Four priority bits: what is stored, and what BASEPRI holds back. */
#include "bench.h"

#define IPR31 (*(volatile uint8_t*)0xE000E41F)
#define ISPR0 REG(0xE000E200)
#define ICPR0 REG(0xE000E280)

static volatile uint32_t taken;
void irq31_handler(void) {
  taken = taken + 1;
}

/* Was the interrupt taken at that priority under that mask? */
static uint32_t passes(uint32_t priority, uint32_t basepri) {
  IPR31 = (uint8_t)priority;
  __asm volatile("msr basepri, %0" ::"r"(basepri));
  taken = 0;
  ISPR0 = 1u << 31;
  __asm volatile("dsb\n isb");
  const uint32_t was = taken;
  ICPR0 = 1u << 31;
  __asm volatile("msr basepri, %0" ::"r"(0));
  return was;
}

int main(void) {
  taken = 0;
  SAY = IPR31;
  IPR31 = 0xFF;
  SAY = IPR31;
  ISER0 = 1u << 31;
  SAY = passes(0x50, 0x50) << 4 | passes(0x50, 0x5F) << 3 | passes(0x40, 0x5F) << 2 |
        passes(0x4F, 0x50) << 1 | passes(0x50, 0x60);
  for (;;) __asm volatile("wfi");
}

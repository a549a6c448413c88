/* STM32F103CB: the same idea; faults on the first word beyond its 128 KiB of flash. */
#include "bench.h"

int main(void) {
  REG(0x20004FF0) = 0x600D;
  register uint32_t flash_KiB __asm("r4") = REG(0x1FFFF7E0) & 0xFFFF;
  register uint32_t cause __asm("r5") = REG(0x40021024); /* RCC_CSR */
  register uint32_t last __asm("r6") = REG(0x20004FF0);
  register uint32_t id __asm("r7") = REG(0xE0042000);
  __asm volatile("ldr r0, =0x08020000\n ldr r0, [r0]" ::"r"(flash_KiB), "r"(cause), "r"(last),
                 "r"(id)
                 : "r0");
  return 0;
}

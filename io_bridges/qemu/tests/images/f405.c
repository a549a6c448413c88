/* STM32F405: collects facts of the part, then faults on the first word beyond SRAM: the stand reads
   the facts in the registers. */
#include "bench.h"

#define RCC_CSR REG(0x40023874)

__attribute__((section(".bss"))) static volatile uint32_t word; /* in CCM */

int main(void) {
  const uint32_t csr = RCC_CSR;
  if ((csr & (1u << 28)) == 0) { /* SFTRSTF: not yet reset by software */
    RCC_CSR = 1u << 24;          /* RMVF */
    AIRCR = 0x05FA0004;
  }
  REG(0x20000100) = 0;
  REG(0x22000000 + 0x100 * 32 + 5 * 4) = 1; /* bit-band alias of bit 5 */
  word = REG(0xE0042000);
  register uint32_t flash_KiB __asm("r4") = REG(0x1FFF7A20) >> 16;
  register uint32_t cause __asm("r5") = csr;
  register uint32_t bits __asm("r6") = REG(0x20000100);
  register uint32_t id __asm("r8") = word;
  __asm volatile("ldr r0, =0x20020000\n ldr r0, [r0]" ::"r"(flash_KiB), "r"(cause), "r"(bits),
                 "r"(id)
                 : "r0");
  return 0;
}

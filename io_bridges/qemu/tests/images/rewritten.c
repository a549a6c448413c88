/* Code that is written while the image runs, over code that has run: NOPs and a return, in SRAM and in
   flash. Says how many cycles each takes. */
#include "bench.h"

#define CYCCNT REG(0xE0001004)
#define IN_SRAM 0x20001000u
#define IN_FLASH 0x08040000u
#define NOP 0xBF00u
#define BX_LR 0x4770u

static uint32_t timed(uint32_t address) {
  uint32_t from, to;
  __asm volatile(".balign 16\n ldr %0, [%2]\n blx %3\n ldr %1, [%2]\n"
                 : "=&r"(from), "=&r"(to)
                 : "r"(&CYCCNT), "r"(address | 1)
                 : "lr", "memory");
  return to - from;
}

static void write_code(uint32_t address, uint32_t nops) {
  for (uint32_t n = 0; n < nops; n += 2) REG(address + 2 * n) = NOP << 16 | NOP;
  REG(address + 2 * nops) = BX_LR << 16 | BX_LR;
  __asm volatile("dsb\n isb" ::: "memory");
}

int main(void) {
  REG(0xE000EDFC) |= 1u << 24;
  REG(0xE0001000) |= 1;
  for (uint32_t nops = 40; nops >= 10; nops -= 10) {
    write_code(IN_SRAM, nops);
    (void)timed(IN_SRAM);
    SAY = timed(IN_SRAM);
  }
  FLASHCR = 1;
  for (uint32_t nops = 40; nops >= 10; nops -= 10) {
    ERASE = IN_FLASH;
    write_code(IN_FLASH, nops);
    (void)timed(IN_FLASH);
    SAY = timed(IN_FLASH);
  }
  for (;;) __asm volatile("wfi");
}

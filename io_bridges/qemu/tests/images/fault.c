/* Reads beyond the part's SRAM, three calls deep. */
#include "bench.h"

__attribute__((noinline)) uint32_t read_beyond(volatile uint32_t* address) {
  return *address + 1;
}
__attribute__((noinline)) uint32_t middle(uint32_t n) {
  return read_beyond((volatile uint32_t*)(uintptr_t)(0x20020000u + n)) + 2;
}

int main(void) {
  SAY = REG(0x2001FFFC); /* the last word that is there */
  return (int)middle(0) + 3;
}

/* A fault, and another one in its handler: the core locks up. */
#include "bench.h"

void hard_fault_handler(void) {
  (void)REG(0x20020000);
}

int main(void) {
  (void)REG(0x20020000);
  return 0;
}

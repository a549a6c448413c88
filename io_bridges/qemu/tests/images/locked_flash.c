/* Stores into flash while nobody opened it: the part answers with a bus fault. */
#include "bench.h"

int main(void) {
  REG(0x08040000) = 1;
  return 0;
}

/* 100 us interrupts that compute a little and sleep: every write of DIGEST folds in its exact time. */
#include "bench.h"

static volatile uint32_t count;
static volatile float value;

void irq31_handler(void) {
  ACK = 0;
  float v = value;
  for (int i = 0; i < 50 + (int)(count % 7) * 11; ++i) v = v * 1.0001f + 0.5f;
  value = v;
  ++count;
  DIGEST = count;
}

int main(void) {
  count = 0;
  value = 1.0f;
  ISER0 = 1u << 31;
  EVERY = 100000;
  for (;;) {
    __asm volatile("wfi");
    if (count % 1000 == 0) SAY = DIGEST;
  }
}

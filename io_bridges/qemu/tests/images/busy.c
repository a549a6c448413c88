/* Floats 100 % of the time. */
#include "bench.h"

volatile float sink;

int main(void) {
  float v = 1.0f;
  for (uint32_t n = 0;; ++n) {
    for (int i = 0; i < 1000; ++i) v = v * 1.0001f + 0.5f / (v + 1.0f);
    sink = v;
  }
}

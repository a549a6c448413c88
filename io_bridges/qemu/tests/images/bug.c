/* Asks the bench part to go wrong in the way of HOW: a bug of ours, not of the firmware. */
#include "bench.h"

int main(void) {
  BUG = HOW;
  for (;;) {
  }
}

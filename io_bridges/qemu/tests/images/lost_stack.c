/* A stack (or the vectors) where there are registers, in the way of HOW:
   1 a push, 2 an exception's entry, 3 its return to a process stack, 4 an entry into flash,
   5 vectors among registers. */
#include "bench.h"

#define MOVE_SP(a) __asm__ volatile("mov sp, %0" ::"r"(a) : "memory")

void hard_fault_handler(void) {
  for (;;) {
  }
}

int main(void) {
#if HOW == 1
  MOVE_SP(0x40000040);
  __asm__ volatile("push {r0-r7}" ::: "memory");
#elif HOW == 2
  MOVE_SP(0x40000080);
  __asm__ volatile("udf #0");
#elif HOW == 3
  __asm__ volatile("msr psp, %0\n mov lr, %1\n svc #0\n" ::"r"(0x40000080), "r"(0xFFFFFFFDu)
                   : "memory");
#elif HOW == 4
  MOVE_SP(0x08001000);
  __asm__ volatile("udf #0");
#else
  REG(0xE000ED08) = 0x40000000; /* VTOR */
  __asm__ volatile("udf #0");
#endif
  return 0;
}

/* Of HOW 3: returns from SVC to the process stack. */
__attribute__((naked)) void svc_handler(void) {
  __asm__ volatile("mvn lr, #2\n bx lr");
}

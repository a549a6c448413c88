/* Vector table and start-up of the test images. .data and .bss are not used by them. */
#include "bench.h"

#ifndef STACK_TOP
#define STACK_TOP 0x20020000u
#endif

__attribute__((weak)) void stuck(void) {
  for (;;) {
  }
}
__attribute__((weak, alias("stuck"))) void irq28_handler(void);
__attribute__((weak, alias("stuck"))) void irq29_handler(void);
__attribute__((weak, alias("stuck"))) void irq30_handler(void);
__attribute__((weak, alias("stuck"))) void irq31_handler(void);
__attribute__((weak, alias("stuck"))) void svc_handler(void);
__attribute__((weak, alias("stuck"))) void pend_sv_handler(void);
__attribute__((weak, alias("stuck"))) void systick_handler(void);
__attribute__((weak, alias("stuck"))) void hard_fault_handler(void);

void reset_handler(void) {
#ifdef __ARM_FP
  REG(0xE000ED88) |= 0xFu << 20; /* CPACR: the FPU on */
#endif
  main();
  stuck();
}

typedef void (*vector)(void);
__attribute__((section(".vectors"), used))
const vector vectors[16 + 82] = {(vector)STACK_TOP,
                                 reset_handler,
                                 stuck,
                                 hard_fault_handler,
                                 stuck,
                                 stuck,
                                 stuck,
                                 0,
                                 0,
                                 0,
                                 0,
                                 svc_handler,
                                 stuck,
                                 0,
                                 pend_sv_handler,
                                 systick_handler,
                                 [16 + 28] = irq28_handler,
                                 irq29_handler,
                                 irq30_handler,
                                 [16 + 31] = irq31_handler};

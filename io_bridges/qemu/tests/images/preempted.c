/* Interrupts that nest three deep and tail-chain, on MSP and then on PSP. Every function's instructions are
   counted, however often and by whom it is preempted:
     spin      1 + 2 x 100 + 1                                 = 202
     work      push, 5 calls of spin, pop                      = 1 + 5 x 203 + 1     = 1017
     irq31     push, acknowledge, spin, pend 30, 2 spin, pop   = 1 + 4 + 203 + 4 + 406 + 1 = 619
     irq30     push, spin, pend 29, 2 spin, pop                = 1 + 203 + 4 + 406 + 1 = 615
     irq29     the same, pends 28                              = 615
     irq28     push, spin, pop                                 = 205
   31 interrupts work, 30 interrupts 31, 29 interrupts 30; 28 has the lowest priority and follows 31. */
#include "bench.h"

#define PRIORITY(irq) (*(volatile uint8_t*)(0xE000E400 + (irq)))

__attribute__((naked, noinline, used)) void spin(void) {
  __asm volatile(
      "movs r0, #100\n"
      "1: subs r0, #1\n"
      "bne 1b\n"
      "bx lr\n");
}
__attribute__((naked, noinline)) void work(void) {
  __asm volatile(
      "push {r4, lr}\n"
      "bl spin\n bl spin\n bl spin\n bl spin\n bl spin\n"
      "pop {r4, pc}\n");
}
/* ISPR0 is 0xE000E200. */
#define PEND(mask) "movw r0, #0xE200\n movt r0, #0xE000\n mov.w r1, #" mask "\n str r1, [r0]\n"

__attribute__((naked)) void irq31_handler(void) {
  __asm volatile(
      "push {r4, lr}\n"
      "movw r0, #0x0010\n movt r0, #0x4000\n movs r1, #0\n str r1, [r0]\n" /* ACK */
      "bl spin\n" PEND("0x40000000")
      "bl spin\n bl spin\n"
      "pop {r4, pc}\n");
}
__attribute__((naked)) void irq30_handler(void) {
  __asm volatile(
      "push {r4, lr}\n"
      "bl spin\n" PEND("0x20000000")
      "bl spin\n bl spin\n"
      "pop {r4, pc}\n");
}
__attribute__((naked)) void irq29_handler(void) {
  __asm volatile(
      "push {r4, lr}\n"
      "bl spin\n" PEND("0x10000000")
      "bl spin\n bl spin\n"
      "pop {r4, pc}\n");
}
__attribute__((naked)) void irq28_handler(void) {
  __asm volatile(
      "push {r4, lr}\n"
      "bl spin\n"
      "pop {r4, pc}\n");
}

static uint32_t process_stack[64];

int main(void) {
  PRIORITY(31) = 0x80;
  PRIORITY(30) = 0x40;
  PRIORITY(29) = 0x00;
  PRIORITY(28) = 0xC0;
  ISER0 = 0xFu << 28;
  TIMER = 4000; /* in the middle of work */
  work();
  __asm volatile(
      "msr psp, %0\n"
      "msr control, %1\n"
      "isb\n" ::"r"(process_stack + 64),
      "r"(2));
  TIMER = 4000;
  work();
  for (;;) __asm volatile("wfi");
}

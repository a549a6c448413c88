/* A small preemptive RTOS: a tick of 1 ms by SysTick, three tasks on stacks of their own (PSP), switched by
   PendSV by priority. Every function's instructions are counted:
     work_fast   every 2 ms    store and spin   3 + 2 x 100 + 2     = 205
     work_slow   every 10 ms   the same         3 + 2 x 140000 + 2   = 280005, which 1 ms ticks and
                                                                    work_fast preempt
   Stacks, deepest: fast the 100 bytes of its work; slow the 400 of its work, the frame of the tick (32)
   and what PendSV saves (32); idle these two only. */
#include "bench.h"

#define ICSR REG(0xE000ED04)
#define SHPR3 REG(0xE000ED20)

enum { fast, slow, idle, tasks };
uint32_t fast_stack[128], slow_stack[256], idle_stack[128];
static struct {
  uint32_t* sp;
  uint32_t wake; /* at this tick; 0: it is ready */
} task[tasks];
static uint32_t current, ticks;

/* svc: sleep for r0 ticks. */
static void sleep_current(const uint32_t* frame) {
  task[current].wake = ticks + frame[0];
  ICSR = 1u << 28;
}
__attribute__((used)) uint32_t* switch_task(uint32_t* sp) {
  task[current].sp = sp;
  current = task[fast].wake == 0 ? fast : task[slow].wake == 0 ? slow : idle;
  return task[current].sp;
}
void systick_handler(void) {
  ++ticks;
  for (int i = 0; i < idle; ++i) {
    if (task[i].wake == ticks) task[i].wake = 0;
  }
  ICSR = 1u << 28;
}
void svc_handler(void) {
  const uint32_t* frame;
  __asm volatile("mrs %0, psp" : "=r"(frame));
  sleep_current(frame);
}
__attribute__((naked)) void pend_sv_handler(void) {
  __asm volatile(
      "mrs r0, psp\n"
      "stmdb r0!, {r4-r11}\n"
      "push {r3, lr}\n"
      "bl switch_task\n"
      "pop {r3, lr}\n"
      "ldmia r0!, {r4-r11}\n"
      "msr psp, r0\n"
      "bx lr\n");
}

__attribute__((naked, noinline, used)) void work_fast(void) {
  __asm volatile(
      "sub sp, #100\n"
      "str r4, [sp]\n"
      "movs r0, #100\n"
      "1: subs r0, #1\n"
      "bne 1b\n"
      "add sp, #100\n"
      "bx lr\n");
}
__attribute__((naked, noinline, used)) void work_slow(void) {
  __asm volatile(
      "sub sp, #400\n"
      "str r4, [sp]\n"
      "ldr r0, =140000\n"
      "1: subs r0, #1\n"
      "bne 1b\n"
      "add sp, #400\n"
      "bx lr\n");
}
__attribute__((naked)) static void run_fast(void) {
  __asm volatile("1: bl work_fast\n movs r0, #2\n svc #0\n b 1b\n");
}
__attribute__((naked)) static void run_slow(void) {
  __asm volatile("1: bl work_slow\n movs r0, #10\n svc #0\n b 1b\n");
}
__attribute__((naked)) static void run_idle(void) {
  __asm volatile("1: wfi\n b 1b\n");
}

static void prepare(int number, uint32_t* top, void (*run)(void)) {
  uint32_t* sp = top - 16; /* r4-r11, r0-r3, r12, lr, pc, xpsr */
  for (int i = 0; i < 14; ++i) sp[i] = 0x01010101u * (uint32_t)i + 0x04040404u;
  sp[14] = (uint32_t)run;
  sp[15] = 1u << 24;
  task[number].sp = sp;
  task[number].wake = 0;
}

int main(void) {
  prepare(fast, fast_stack + 128, run_fast);
  prepare(slow, slow_stack + 256, run_slow);
  prepare(idle, idle_stack + 128, run_idle);
  current = idle;
  ticks = 0;
  SHPR3 = 0xF0F00000u; /* PendSV and SysTick */
  REG(0xE000E014) = 168000 - 1;
  REG(0xE000E018) = 0;
  REG(0xE000E010) = 7;
  /* The first switch saves into idle's stack what is thrown away; then into the first task. */
  __asm volatile(
      "msr psp, %0\n"
      "msr control, %1\n"
      "isb\n" ::"r"(idle_stack + 128),
      "r"(2));
  run_idle();
  return 0;
}

/* For the test images: the bench part's register block (io_bridges/qemu/board/bench_chip.hpp), the
   core's registers, and a vector table. Freestanding C for arm-none-eabi-gcc. */
#pragma once
#include <stdint.h>

#define REG(a) (*(volatile uint32_t*)(a))
#define TIME REG(0x40000000)
#define TIMER REG(0x40000008)
#define EVERY REG(0x4000000C)
#define ACK REG(0x40000010)
#define DIGEST REG(0x40000014)
#define SAY REG(0x40000018)
#define RESET_BY REG(0x4000001C)
#define FLASHCR REG(0x40000020)
#define ERASE REG(0x40000024)
#define CAUSE REG(0x40000028)
#define BUG REG(0x40000030)
#define ISER0 REG(0xE000E100)
#define AIRCR REG(0xE000ED0C)

extern int main(void);
void reset_handler(void);
void stuck(void);
void irq28_handler(void);
void irq29_handler(void);
void irq30_handler(void);
void irq31_handler(void);
void svc_handler(void);
void pend_sv_handler(void);
void systick_handler(void);
void hard_fault_handler(void);

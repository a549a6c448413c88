/* Vector table, start-up and report lines of the driver-style images. */
#include "f405.h"

extern uint32_t data_start[], data_end[], data_load[], bss_start[], bss_end[];
extern uint32_t stack_top[];

static void unexpected(void) {
  for (;;) {
  }
}

void reset_handler(void) {
  REG(0xE000ED88) |= 0xFu << 20; /* CPACR: the FPU on */
  for (uint32_t *to = data_start, *from = data_load; to != data_end;) *to++ = *from++;
  for (uint32_t* to = bss_start; to != bss_end;) *to++ = 0;
  main();
  unexpected();
}

void say(const char* name, uint32_t value) {
  char digits[10];
  int n = 0;
  while (*name != 0) send(*name++);
  send(' ');
  do {
    digits[n++] = (char)('0' + value % 10);
    value /= 10;
  } while (value != 0);
  while (n > 0) send(digits[--n]);
  send('\n');
}

void clock_168_MHz(void) {
  RCC->CR |= 1u << 16;
  while ((RCC->CR & 1u << 17) == 0) {
  }
  RCC->APB1ENR |= 1u << 28;
  PWR_CR |= 1u << 14;
  RCC->PLLCFGR = 8 | 336u << 6 | 1u << 22 | 7u << 24;
  RCC->CR |= 1u << 24;
  while ((RCC->CR & 1u << 25) == 0) {
  }
  FLASH_ACR = 1u << 8 | 1u << 9 | 1u << 10 | 5;
  RCC->CFGR = 2 | 4u << 13 | 5u << 10;
  while ((RCC->CFGR & 0xC) != 8) {
  }
  DEMCR |= 1u << 24;
  DWT_CYCCNT = 0;
  DWT_CTRL |= 1;
}

#define HANDLER(name) __attribute__((weak, alias("unexpected"))) void name(void)
HANDLER(SysTick_Handler);
HANDLER(WWDG_Handler);
HANDLER(EXTI0_Handler);
HANDLER(EXTI1_Handler);
HANDLER(EXTI3_Handler);
HANDLER(ADC_Handler);
HANDLER(CAN1_RX0_Handler);
HANDLER(TIM1_CC_Handler);
HANDLER(TIM2_Handler);
HANDLER(TIM3_Handler);
HANDLER(TIM4_Handler);
HANDLER(I2C2_EV_Handler);
HANDLER(I2C2_ER_Handler);
HANDLER(SPI2_Handler);
HANDLER(USART2_Handler);
HANDLER(RTC_Alarm_Handler);
HANDLER(UART4_Handler);
HANDLER(USART6_Handler);
HANDLER(DMA2_Stream0_Handler);

typedef void (*vector)(void);
__attribute__((section(".vectors"), used))
const vector vectors[16 + 82] = {(vector)stack_top,
                                 reset_handler,
                                 unexpected,
                                 unexpected,
                                 unexpected,
                                 unexpected,
                                 unexpected,
                                 0,
                                 0,
                                 0,
                                 0,
                                 unexpected,
                                 unexpected,
                                 0,
                                 unexpected,
                                 SysTick_Handler,
                                 [16 + 0] = WWDG_Handler,
                                 [16 + 6] = EXTI0_Handler,
                                 [16 + 7] = EXTI1_Handler,
                                 [16 + 9] = EXTI3_Handler,
                                 [16 + 18] = ADC_Handler,
                                 [16 + 20] = CAN1_RX0_Handler,
                                 [16 + 27] = TIM1_CC_Handler,
                                 [16 + 28] = TIM2_Handler,
                                 [16 + 29] = TIM3_Handler,
                                 [16 + 30] = TIM4_Handler,
                                 [16 + 33] = I2C2_EV_Handler,
                                 [16 + 34] = I2C2_ER_Handler,
                                 [16 + 36] = SPI2_Handler,
                                 [16 + 38] = USART2_Handler,
                                 [16 + 41] = RTC_Alarm_Handler,
                                 [16 + 52] = UART4_Handler,
                                 [16 + 56] = DMA2_Stream0_Handler,
                                 [16 + 71] = USART6_Handler};

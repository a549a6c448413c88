/* Drivers as libopencm3 makes its way: one small function per register field, plain loops on flags.
   The image lives through three resets: power-on, independent watchdog, window watchdog; backup
   registers and RCC_CSR tell it where it is. Board: 8 MHz crystal, a terminal on USART2. */
#include "f405.h"

#define SET(reg, bits) ((reg) |= (bits))
#define CLEAR(reg, bits) ((reg) &= ~(bits))

static volatile uint32_t ticks, early;

void SysTick_Handler(void) {
  ++ticks;
}

void WWDG_Handler(void) {
  ++early;
  REG(0x40002C08) = 0;
  if (early < 4) REG(0x40002C00) = 0x7F; /* fed from the early wake-up three times, then no more */
}

static void rcc_clock_setup_hse_8mhz(void) {
  SET(RCC->CR, 1);
  while ((RCC->CR & 2) == 0) {
  }
  RCC->CFGR = (RCC->CFGR & ~3u) | 0;
  while ((RCC->CFGR >> 2 & 3) != 0) {
  }
  SET(RCC->CR, 1u << 16);
  while ((RCC->CR & 1u << 17) == 0) {
  }
  SET(RCC->APB1ENR, 1u << 28);
  SET(PWR_CR, 1u << 14);
  RCC->CFGR = (RCC->CFGR & ~(0xFu << 4 | 7u << 10 | 7u << 13)) | 5u << 10 | 4u << 13;
  RCC->PLLCFGR = 8 | 336u << 6 | 0u << 16 | 1u << 22 | 7u << 24;
  SET(RCC->CR, 1u << 24);
  while ((RCC->CR & 1u << 25) == 0) {
  }
  FLASH_ACR = 1u << 9 | 1u << 10 | 5;
  RCC->CFGR = (RCC->CFGR & ~3u) | 2;
  while ((RCC->CFGR >> 2 & 3) != 2) {
  }
  CLEAR(RCC->CR, 1);
}

static void gpio_mode_af(gpio_t* port, unsigned pin, uint32_t af) {
  port->MODER = (port->MODER & ~(3u << 2 * pin)) | 2u << 2 * pin;
  port->AFR[pin / 8] = (port->AFR[pin / 8] & ~(15u << 4 * (pin % 8))) | af << 4 * (pin % 8);
}

static void usart_setup(void) {
  SET(RCC->AHB1ENR, 1);
  SET(RCC->APB1ENR, 1u << 17);
  gpio_mode_af(GPIOA, 2, 7);
  USART2->BRR = (2 * 42000000 + 115200) / (2 * 115200);
  USART2->CR1 = (USART2->CR1 & ~(1u << 12)) | 1u << 3;
  SET(USART2->CR1, 1u << 13);
}

/* usart_send_blocking */
void send(char c) {
  while ((USART2->SR & 1u << 7) == 0) {
  }
  USART2->DR = (uint32_t)c & 0x1FF;
}

static void drain(void) {
  while ((USART2->SR & 1u << 6) == 0) {
  }
}

static void systick_setup(void) {
  SYSTICK_LOAD = 168000 - 1;
  SYSTICK_VAL = 0;
  SET(SYSTICK_CTRL, 7);
}

static void msleep(uint32_t delay) {
  const uint32_t wake = ticks + delay;
  while (wake > ticks) {
  }
}

/* timer_one_shot_mode, timer_enable_counter: a pulse of 1 ms measured by the tick. */
static void one_shot(void) {
  SET(RCC->APB1ENR, 1u << 3);
  SET(RCC->APB1RSTR, 1u << 3);
  CLEAR(RCC->APB1RSTR, 1u << 3);
  tim_t* tim5 = TIM5;
  tim5->PSC = 84 - 1;
  tim5->ARR = 100000 - 1; /* more than 16 bits */
  SET(tim5->CR1, 1u << 3);
  SET(tim5->EGR, 1);
  CLEAR(tim5->SR, 1);
  const uint32_t start = ticks;
  SET(tim5->CR1, 1);
  while ((tim5->CR1 & 1) != 0) {
  }
  say("one_shot_ms", ticks - start);
}

/* can_reset, can_init(loopback), can_filter_id_mask_32bit_init, can_transmit, can_receive. */
static void can_loopback(void) {
  SET(RCC->APB1ENR, 1u << 25);
  CLEAR(CAN(0), 2);
  SET(CAN(0), 1);
  uint32_t wait = 0;
  while ((CAN(4) & 1) == 0 && ++wait < 0xFFFFF) {
  }
  say("can_init", (CAN(4) & 3) == 1);
  CAN(0x1C) = 1u << 30 | 10u << 16 | 1u << 20 | 2; /* 1 Mbit/s */
  CLEAR(CAN(0), 1);
  while ((CAN(4) & 1) != 0) {
  }
  SET(CAN(0x200), 1);
  CLEAR(CAN(0x21C), 1);
  SET(CAN(0x20C), 1);
  CLEAR(CAN(0x204), 1);
  CAN(0x240) = 0x120u << 21;
  CAN(0x244) = 0x7F0u << 21; /* 0x120..0x12F */
  CLEAR(CAN(0x214), 1);
  SET(CAN(0x21C), 1);
  CLEAR(CAN(0x200), 1);
  for (uint32_t id = 0x11E; id <= 0x121; ++id) {
    while ((CAN(8) & 1u << 26) == 0) {
    }
    CAN(0x188) = id;
    CAN(0x184) = (CAN(0x184) & ~15u) | 4;
    CAN(0x180) = id << 21;
    SET(CAN(0x180), 1);
  }
  msleep(2);
  say("can_pending", CAN(12) & 3);
  uint32_t sum = 0;
  while ((CAN(12) & 3) != 0) {
    sum = sum * 1000 + (CAN(0x1B0) >> 21) + CAN(0x1B8);
    SET(CAN(12), 1u << 5);
    while ((CAN(12) & 1u << 5) != 0) {
    }
  }
  say("can_sum", sum);
}

/* iwdg_set_period_ms(50), iwdg_start: never fed. */
static void starve_independent(void) {
  IWDG_KR = 0x5555;
  IWDG_PR = 0;
  while ((IWDG_SR & 1) != 0) {
  }
  IWDG_KR = 0x5555;
  IWDG_RLR = 400 - 1; /* 400 * 4 / 32 kHz: 50 ms */
  while ((IWDG_SR & 2) != 0) {
  }
  IWDG_KR = 0xAAAA;
  IWDG_KR = 0xCCCC;
  for (;;) RTC->BKP[2] = ticks;
}

static void starve_window(void) {
  SET(RCC->APB1ENR, 1u << 11);
  REG(0x40002C04) = 0x7F | 1u << 9 | 3u << 7; /* 42 MHz / 4096 / 8: 780 us a count */
  REG(0x40002C08) = 0;
  NVIC_ISER(0) = 1;
  REG(0x40002C00) = 0xFF;
  for (;;) {
    RTC->BKP[2] = ticks;
    RTC->BKP[3] = early;
  }
}

int main(void) {
  rcc_clock_setup_hse_8mhz();
  usart_setup();
  systick_setup();
  SET(PWR_CR, 1u << 8);
  const uint32_t cause = RCC->CSR >> 24;
  SET(RCC->CSR, 1u << 24);
  if (RTC->BKP[0] != 0xC0FFEE) {
    RTC->BKP[0] = 0xC0FFEE;
    RTC->BKP[1] = 1;
    say("power_on", cause >> 3 & 1);
    one_shot();
    can_loopback();
    drain();
    starve_independent();
  } else if (RTC->BKP[1] == 1) {
    RTC->BKP[1] = 2;
    say("iwdg_flag", cause >> 5 & 1);
    say("power_on_again", cause >> 3 & 1);
    say("iwdg_alive_ms", RTC->BKP[2]);
    drain();
    starve_window();
  }
  say("wwdg_flag", cause >> 6 & 1);
  say("wwdg_warnings", RTC->BKP[3]);
  say("wwdg_alive_ms", RTC->BKP[2]);
  say("done", 1);
  for (;;) wait_for_interrupt();
}

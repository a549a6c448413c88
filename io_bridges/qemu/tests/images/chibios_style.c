/* Drivers as ChibiOS makes its way: a tickless system timer (32-bit free-running counter, alarms by
   compare), transmission from a queue by TXE interrupts, continuous conversions by circular DMA with
   half and full callbacks, an input capture unit. Board: 8 MHz crystal, 1.1 V on PA1, a jumper from
   PB0 (TIM3_CH3) to PB6 (TIM4_CH1), a terminal on USART2. */
#include "f405.h"

static char queue[256];
static volatile uint8_t queue_in, queue_out;
static volatile uint32_t alarms, halves, fulls, widths, width, periods, period, alarm_a;
static volatile uint32_t last_alarm, latest_late;
static uint16_t ring[16];

static void stm32_clock_init(void) {
  RCC->APB1ENR = 1u << 28;
  PWR_CR = 1u << 14;
  RCC->CR |= 1;
  while ((RCC->CR & 2) == 0) {
  }
  RCC->CR = (RCC->CR & 0xF8) | 1;
  RCC->CFGR = 0;
  while ((RCC->CFGR & 0xC) != 0) {
  }
  RCC->CR |= 1u << 16;
  while ((RCC->CR & 1u << 17) == 0) {
  }
  RCC->PLLCFGR = 8 | 336u << 6 | 1u << 22 | 7u << 24;
  RCC->CR |= 1u << 24;
  while ((PWR_CSR & 1u << 14) == 0) { /* the regulator's ready bit */
  }
  while ((RCC->CR & 1u << 25) == 0) {
  }
  RCC->CFGR = 4u << 13 | 5u << 10;
  FLASH_ACR = 1u << 8 | 1u << 9 | 1u << 10 | 5;
  RCC->CFGR |= 2;
  while ((RCC->CFGR & 0xC) != 8) {
  }
}

static void pal(gpio_t* port, unsigned pin, uint32_t mode, uint32_t af) {
  port->AFR[pin / 8] = (port->AFR[pin / 8] & ~(15u << 4 * (pin % 8))) | af << 4 * (pin % 8);
  port->MODER = (port->MODER & ~(3u << 2 * pin)) | mode << 2 * pin;
}

/* Serial driver: DR is fed by the TXE interrupt until the queue is empty, then TC ends it. */
static void sd_start(void) {
  RCC->APB1ENR |= 1u << 17;
  RCC->AHB1ENR |= 7;
  pal(GPIOA, 2, 2, 7);
  USART2->BRR = 42000000 / 115200;
  USART2->CR3 = 1;
  USART2->CR1 = 1u << 13 | 1u << 8 | 1u << 5 | 1u << 3 | 1u << 2;
  USART2->SR = 0;
  (void)USART2->SR;
  (void)USART2->DR;
  NVIC_IPR(38) = 0xC0;
  NVIC_ISER(1) = 1u << 6;
}

void USART2_Handler(void) {
  const uint32_t sr = USART2->SR;
  if ((USART2->CR1 & 0x80) != 0 && (sr & 0x80) != 0) {
    if (queue_in == queue_out) {
      USART2->CR1 = (USART2->CR1 & ~0x80u) | 0x40;
    } else {
      USART2->DR = (uint8_t)queue[queue_out++];
    }
  }
  if ((USART2->CR1 & 0x40) != 0 && (sr & 0x40) != 0) {
    USART2->CR1 &= ~0x40u;
    USART2->SR = ~0x40u;
  }
}

void send(char c) {
  while ((uint8_t)(queue_in + 1) == queue_out) wait_for_interrupt();
  disable_interrupts();
  queue[queue_in++] = c;
  USART2->CR1 |= 0x80;
  enable_interrupts();
}

/* System timer: TIM2 at 1 MHz. */
static void st_init(void) {
  RCC->APB1ENR |= 1;
  TIM2->PSC = 84 - 1;
  TIM2->ARR = 0xFFFFFFFF;
  TIM2->CCMR1 = 0;
  TIM2->CCR1 = 0;
  TIM2->DIER = 0;
  TIM2->CR2 = 0;
  TIM2->EGR = 1;
  TIM2->CR1 = 1;
  NVIC_IPR(28) = 0x80;
  NVIC_ISER(0) = 1u << 28;
}

static void st_set_alarm(uint32_t time) {
  last_alarm = time;
  TIM2->CCR1 = time;
  TIM2->SR = 0;
  TIM2->DIER = 2;
}

void TIM2_Handler(void) {
  uint32_t sr = TIM2->SR;
  sr &= TIM2->DIER;
  TIM2->SR = ~sr;
  if ((sr & 2) == 0) return;
  const uint32_t late = TIM2->CNT - last_alarm;
  if (late > latest_late) latest_late = late;
  ++alarms;
  if (alarms < 200) {
    st_set_alarm(last_alarm + 137 + alarms);
  } else {
    TIM2->DIER = 0;
  }
}

static void sleep_us(uint32_t us) {
  const uint32_t start = TIM2->CNT;
  st_set_alarm(start + us);
  while (TIM2->CNT - start < us) wait_for_interrupt();
}

static void tickless(void) {
  const uint32_t start = TIM2->CNT;
  st_set_alarm(start + 100);
  while (alarms < 200) wait_for_interrupt();
  say("alarms", alarms);
  say("alarms_us", last_alarm - start);
  say("alarm_prompt", latest_late <= 2);
}

/* adcStartConversion: two channels, circular, depth 8, half and full callbacks. */
static void adc_start(void) {
  RCC->AHB1ENR |= 1u << 22;
  RCC->APB2ENR |= 1u << 8;
  pal(GPIOA, 1, 3, 0);
  dma_stream_t* stream = &DMA2->S[0];
  DMA2->LIFCR = 0x3D;
  stream->PAR = (uint32_t)(uintptr_t)&ADC1->DR;
  stream->M0AR = (uint32_t)(uintptr_t)ring;
  stream->NDTR = 16;
  stream->FCR = 0;
  stream->CR = 1u << 8 | 1u << 13 | 1u << 11 | 1u << 10 | 3u << 3 | 3u << 16;
  NVIC_IPR(56) = 0x50;
  NVIC_ISER(1) = 1u << 24;
  ADC_CCR = 1u << 16 | 1u << 23;
  ADC1->CR1 = 0;
  ADC1->CR2 = 1;
  ADC1->CR2 = 0;
  ADC1->SR = 0;
  ADC1->SMPR1 = 7u << 21;
  ADC1->SMPR2 = 7u << 3;
  ADC1->SQR1 = 1u << 20;
  ADC1->SQR3 = 1 | 17u << 5;
  stream->CR |= 1;
  ADC1->CR1 = 1u << 26 | 1u << 8;
  ADC1->CR2 = 1u << 8 | 1u << 9 | 2 | 1;
  ADC1->CR2 |= 1u << 30;
}

void DMA2_Stream0_Handler(void) {
  const uint32_t flags = DMA2->LISR & 0x3D;
  DMA2->LIFCR = flags;
  if ((flags & 0x10) != 0) ++halves;
  if ((flags & 0x20) != 0) ++fulls;
}

static void adc(void) {
  adc_start();
  sleep_us(10000);
  ADC1->CR2 = 0;
  const uint32_t full_callbacks = fulls; /* disabling the stream raises one more */
  DMA2->S[0].CR &= ~1u;
  say("adc_fulls", full_callbacks);
  say("adc_last_full", fulls - full_callbacks);
  say("adc_pin", ring[0]);
  say("adc_vref", ring[1]);
  say("adc_overrun", ADC1->SR >> 5 & 1);
}

/* Input capture unit: TIM4 in reset mode on TI1, width in CCR2, period in CCR1, all by interrupt. */
void TIM4_Handler(void) {
  uint32_t sr = TIM4->SR;
  sr &= TIM4->DIER;
  TIM4->SR = ~sr;
  if ((sr & 4) != 0) {
    width = TIM4->CCR2;
    ++widths;
  }
  if ((sr & 2) != 0) {
    period = TIM4->CCR1;
    ++periods;
  }
}

static void icu(void) {
  RCC->APB1ENR |= 3u << 1;
  pal(GPIOB, 0, 2, 2);
  pal(GPIOB, 6, 2, 2);
  TIM4->PSC = 84 - 1;
  TIM4->ARR = 0xFFFF;
  TIM4->CCMR1 = 0x0201;
  TIM4->CCER = 1u << 0 | 1u << 4 | 1u << 5;
  TIM4->SMCR = 0x54;
  TIM4->EGR = 1;
  TIM4->SR = 0;
  TIM4->DIER = 6;
  NVIC_IPR(30) = 0x70;
  NVIC_ISER(0) = 1u << 30;
  TIM4->CR1 = 5;
  TIM3->CR1 = 0;
  TIM3->PSC = 84 - 1;
  TIM3->ARR = 2500 - 1;
  TIM3->CCMR2 = 0x68;
  TIM3->CCR3 = 1500;
  TIM3->CCER = 1u << 8;
  TIM3->EGR = 1;
  TIM3->CR1 = 0x81;
  sleep_us(26000);
  say("icu_period", period);
  say("icu_width", width);
  say("icu_count_right", widths >= 10 && widths <= 11 && periods >= 10 && periods <= 11);
}

void RTC_Alarm_Handler(void) {
  if ((RTC->ISR & 1u << 8) != 0) {
    RTC->ISR &= ~(1u << 8 | 1u << 7);
    ++alarm_a;
  }
  EXTI_PR = 1u << 17;
}

/* RTC on LSI with alarm A each second through EXTI line 17. */
static void rtc(void) {
  PWR_CR |= 1u << 8;
  RCC->CSR |= 1;
  while ((RCC->CSR & 2) == 0) {
  }
  RCC->BDCR = 2u << 8 | 1u << 15;
  RTC->WPR = 0xCA;
  RTC->WPR = 0x53;
  RTC->ISR |= 1u << 7;
  while ((RTC->ISR & 1u << 6) == 0) {
  }
  RTC->PRER = 249;
  RTC->PRER = 127u << 16 | 249;
  RTC->TR = 0;
  RTC->ISR &= ~(1u << 7);
  RTC->CR &= ~(1u << 8);
  while ((RTC->ISR & 1) == 0) {
  }
  RTC->ALRMAR = 0x80808080u;
  RTC->CR |= 1u << 8 | 1u << 12;
  EXTI_IMR |= 1u << 17;
  EXTI_RTSR |= 1u << 17;
  NVIC_IPR(41) = 0xF0;
  NVIC_ISER(1) = 1u << 9;
  sleep_us(3500000);
  say("rtc_alarms", alarm_a);
}

int main(void) {
  stm32_clock_init();
  st_init();
  sd_start();
  enable_interrupts();
  tickless();
  adc();
  icu();
  rtc();
  say("done", 1);
  for (;;) wait_for_interrupt();
}

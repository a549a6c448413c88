/* Drivers as ST's HAL makes its way: handles of flags polled against a millisecond tick, every wait
   with a time-out that is reported, interrupts that clear one flag each. Board: 8 MHz crystal,
   1.65 V on PA1, a jumper from PB6 to PA8, a terminal on USART2. */
#include "f405.h"

static volatile uint32_t tick;
static volatile uint32_t updates;
static volatile uint32_t dma_done;
static uint16_t samples[4];

void SysTick_Handler(void) {
  ++tick;
}

static uint32_t failures;

/* HAL_xxx: poll until (reg & mask) == want, at most ms milliseconds. */
static void await(reg32* reg, uint32_t mask, uint32_t want, uint32_t ms) {
  const uint32_t start = tick;
  while ((*reg & mask) != want) {
    if (tick - start > ms) {
      ++failures;
      return;
    }
  }
}

static void delay_ms(uint32_t ms) {
  const uint32_t start = tick;
  while (tick - start < ms + 1) {
  }
}

static void systick_config(uint32_t hclk) {
  SYSTICK_LOAD = hclk / 1000 - 1;
  SYSTICK_VAL = 0;
  SYSTICK_CTRL = 7;
}

static void clock_config(void) {
  systick_config(16000000);
  RCC->APB1ENR |= 1u << 28;
  (void)RCC->APB1ENR; /* the delay after an RCC enable */
  PWR_CR |= 1u << 14;
  RCC->CR |= 1u << 16;
  await(&RCC->CR, 1u << 17, 1u << 17, 100);
  RCC->CR &= ~(1u << 24);
  await(&RCC->CR, 1u << 25, 0, 2);
  RCC->PLLCFGR = 8 | 336u << 6 | 0u << 16 | 1u << 22 | 7u << 24;
  RCC->CR |= 1u << 24;
  await(&RCC->CR, 1u << 25, 1u << 25, 2);
  FLASH_ACR = (FLASH_ACR & ~7u) | 5;
  if ((FLASH_ACR & 7) != 5) ++failures;
  RCC->CFGR = (RCC->CFGR & ~0xFCF0u) | 5u << 10 | 4u << 13;
  RCC->CFGR = (RCC->CFGR & ~3u) | 2;
  await(&RCC->CFGR, 0xC, 8, 5000);
  systick_config(168000000);
}

static void gpio_init(gpio_t* port, unsigned pin, uint32_t mode, uint32_t af) {
  port->AFR[pin / 8] = (port->AFR[pin / 8] & ~(15u << (4 * (pin % 8)))) | af << (4 * (pin % 8));
  port->MODER = (port->MODER & ~(3u << (2 * pin))) | mode << (2 * pin);
}

static void uart_init(void) {
  RCC->AHB1ENR |= 7;
  RCC->APB1ENR |= 1u << 17;
  gpio_init(GPIOA, 2, 2, 7);
  gpio_init(GPIOA, 3, 2, 7);
  USART2->CR1 &= ~(1u << 13);
  USART2->CR1 = 0xC;
  USART2->BRR = (42000000 + 57600) / 115200;
  USART2->CR1 |= 1u << 13;
}

void send(char c) {
  await(&USART2->SR, 0x80, 0x80, 100);
  USART2->DR = (uint8_t)c;
  await(&USART2->SR, 0x40, 0x40, 100);
}

void TIM3_Handler(void) {
  if ((TIM3->SR & 1) != 0 && (TIM3->DIER & 1) != 0) {
    TIM3->SR = ~1u;
    ++updates;
  }
}

/* HAL_TIM_Base_Start_IT: 1 kHz. */
static void time_base(void) {
  RCC->APB1ENR |= 1u << 1;
  TIM3->ARR = 9;
  TIM3->PSC = 8399;
  TIM3->EGR = 1;
  TIM3->SR = ~1u;
  NVIC_IPR(29) = 0x50;
  NVIC_ISER(0) = 1u << 29;
  TIM3->DIER |= 1;
  TIM3->CR1 |= 1;
  const uint32_t start = updates;
  delay_ms(99); /* HAL_Delay adds one tick */
  say("tim3_updates", updates - start);
  TIM3->DIER &= ~1u;
  TIM3->CR1 &= ~1u;
}

/* HAL_TIM_PWM_Start on TIM4 CH1 (PB6), measured by HAL_TIM_IC_Start on TIM1 in reset mode (PA8). */
static void pwm_input(void) {
  RCC->APB1ENR |= 1u << 2;
  RCC->APB2ENR |= 1;
  gpio_init(GPIOB, 6, 2, 2);
  gpio_init(GPIOA, 8, 2, 1);
  TIM4->PSC = 83;
  TIM4->ARR = 1999;
  TIM4->EGR = 1;
  TIM4->CCMR1 = 0x68;
  TIM4->CCR1 = 500;
  TIM4->CCER |= 1;
  TIM4->CR1 |= 0x80;
  TIM4->CR1 |= 1;
  TIM1->PSC = 167;
  TIM1->ARR = 0xFFFF;
  TIM1->EGR = 1;
  TIM1->CCMR1 = 0x0201;
  TIM1->CCER = 0x20;
  TIM1->SMCR = 0x54;
  TIM1->CCER |= 0x11;
  TIM1->CR1 |= 1;
  delay_ms(10);
  say("pwm_period_us", TIM1->CCR1);
  say("pwm_high_us", TIM1->CCR2);
}

/* HAL_ADC_Start, PollForConversion, GetValue; then four conversions by DMA. */
static void adc(void) {
  RCC->APB2ENR |= 1u << 8;
  RCC->AHB1ENR |= 1u << 22;
  gpio_init(GPIOA, 1, 3, 0);
  ADC_CCR = 1u << 16;
  ADC1->SQR1 = 0;
  ADC1->SQR3 = 1;
  ADC1->SMPR2 = 4u << 3;
  ADC1->CR2 = 1u << 10;
  ADC1->CR2 |= 1;
  delay_ms(0);
  ADC1->SR = ~0x22u;
  ADC1->CR2 |= 1u << 30;
  await(&ADC1->SR, 2, 2, 10);
  say("adc_poll", ADC1->DR);
  ADC1->CR2 &= ~1u;

  dma_stream_t* stream = &DMA2->S[0];
  stream->CR = 0;
  await(&stream->CR, 1, 0, 5);
  DMA2->LIFCR = 0x3D;
  stream->PAR = (uint32_t)(uintptr_t)&ADC1->DR;
  stream->M0AR = (uint32_t)(uintptr_t)samples;
  stream->NDTR = 4;
  stream->CR = 1u << 13 | 1u << 11 | 1u << 10 | 1u << 4;
  NVIC_ISER(1) = 1u << (56 - 32);
  stream->CR |= 1;
  ADC_CCR |= 1u << 23;
  ADC1->CR1 = 1u << 8;
  ADC1->SQR1 = 3u << 20;
  ADC1->SQR3 = 1 | 16u << 5 | 17u << 10 | 1u << 15;
  ADC1->CR2 = 1u << 8;
  ADC1->CR2 |= 1;
  ADC1->CR2 |= 1u << 30;
  delay_ms(1);
  say("adc_dma_done", dma_done);
  for (int i = 0; i < 4; ++i) say("adc_dma", samples[i]);
}

void DMA2_Stream0_Handler(void) {
  if ((DMA2->LISR & 0x20) != 0) {
    DMA2->LIFCR = 0x20;
    ++dma_done;
  }
}

static void crc_and_rng(void) {
  RCC->AHB1ENR |= 1u << 12;
  RCC->AHB2ENR |= 1u << 6;
  CRC_CR |= 1;
  CRC_DR = 0;
  say("crc", CRC_DR);
  RNG_CR |= 4;
  await(&RNG_SR, 1, 1, 2);
  const uint32_t first = RNG_DR;
  await(&RNG_SR, 1, 1, 2);
  say("rng_differs", first != RNG_DR);
}

/* HAL_RTC_Init on LSI, SetTime, and a second later GetTime. */
static void rtc(void) {
  PWR_CR |= 1u << 8;
  await(&PWR_CR, 1u << 8, 1u << 8, 2);
  RCC->CSR |= 1;
  await(&RCC->CSR, 2, 2, 2);
  RCC->BDCR = (RCC->BDCR & ~0x300u) | 0x200;
  RCC->BDCR |= 1u << 15;
  RTC->WPR = 0xCA;
  RTC->WPR = 0x53;
  RTC->ISR = 0xFFFFFFFF;
  await(&RTC->ISR, 0x40, 0x40, 1000);
  RTC->CR &= ~0x600040u;
  RTC->PRER = 249;
  RTC->PRER |= 127u << 16;
  RTC->TR = 0x123458;
  RTC->DR = 0x26B121;
  RTC->ISR &= ~0x80u;
  RTC->ISR &= ~0xA0u;
  await(&RTC->ISR, 0x20, 0x20, 1000);
  RTC->WPR = 0xFF;
  say("rtc_hms", RTC->TR);
  (void)RTC->DR;
  delay_ms(2000);
  say("rtc_hms", RTC->TR);
  say("rtc_date", RTC->DR);
}

static void iwdg(void) {
  IWDG_KR = 0xCCCC;
  IWDG_KR = 0x5555;
  IWDG_PR = 3;
  IWDG_RLR = 999;
  await(&IWDG_SR, 3, 0, 48);
  IWDG_KR = 0xAAAA;
  delay_ms(500);
  IWDG_KR = 0xAAAA;
  delay_ms(900); /* of 1000 */
  IWDG_KR = 0xAAAA;
}

int main(void) {
  clock_config();
  uart_init();
  say("failures", failures);
  time_base();
  pwm_input();
  adc();
  crc_and_rng();
  rtc();
  iwdg();
  say("failures", failures);
  say("done", 1);
  for (;;) {
    wait_for_interrupt();
    IWDG_KR = 0xAAAA;
  }
}

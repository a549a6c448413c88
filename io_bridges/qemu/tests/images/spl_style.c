/* Drivers as ST's Standard Peripheral Library makes its way: init structures written in one go,
   counted time-outs, flags cleared by their complement. Board: 8 MHz crystal, 0.825 V on PA1, 2.475 V
   on PA4, a jumper from PC0 to PA0, a terminal on USART2, nothing on I2C1. */
#include "f405.h"

#define HSE_STARTUP_TIMEOUT 0x05000u

static volatile uint32_t edges, edge_cycles;
static volatile uint32_t words[64];
static uint32_t copied[64];
static uint32_t burst[3] = {100, 200, 300};

static void system_init(void) {
  RCC->CR |= 1;
  RCC->CFGR = 0;
  RCC->CR &= 0xFEF6FFFFu;
  RCC->PLLCFGR = 0x24003010;
  RCC->CR &= 0xFFFBFFFFu;
  RCC->CIR = 0;
  RCC->CR |= 1u << 16;
  for (uint32_t n = 0; (RCC->CR & 1u << 17) == 0 && n != HSE_STARTUP_TIMEOUT; ++n) {
  }
  RCC->APB1ENR |= 1u << 28;
  PWR_CR |= 1u << 14;
  RCC->CFGR |= 0;
  RCC->CFGR |= 4u << 13;
  RCC->CFGR |= 5u << 10;
  RCC->PLLCFGR = 8 | 336u << 6 | 0u << 16 | 1u << 22 | 7u << 24;
  RCC->CR |= 1u << 24;
  while ((RCC->CR & 1u << 25) == 0) {
  }
  FLASH_ACR = 1u << 8 | 1u << 9 | 1u << 10 | 5;
  RCC->CFGR &= ~3u;
  RCC->CFGR |= 2;
  while ((RCC->CFGR & 0xCu) != 8) {
  }
}

static void pin_mode(gpio_t* port, unsigned pin, uint32_t mode, uint32_t af) {
  port->AFR[pin >> 3] &= ~(0xFu << ((pin & 7) * 4));
  port->AFR[pin >> 3] |= af << ((pin & 7) * 4);
  port->MODER &= ~(3u << (pin * 2));
  port->MODER |= mode << (pin * 2);
}

static void usart_init(void) {
  RCC->APB1ENR |= 1u << 17;
  RCC->AHB1ENR |= 7;
  pin_mode(GPIOA, 2, 2, 7);
  USART2->CR2 &= ~0x3000u;
  USART2->CR1 = 0xC;
  /* USART_Init: 25 * clock / (4 * baud), then mantissa and rounded fraction. */
  const uint32_t integer = 25u * 42000000u / (4u * 115200u);
  const uint32_t mantissa = integer / 100 << 4;
  const uint32_t fraction = integer - 100 * (mantissa >> 4);
  USART2->BRR = (uint16_t)(mantissa | ((((fraction * 16) + 50) / 100) & 0xF));
  USART2->CR1 |= 0x2000;
}

void send(char c) {
  while ((USART2->SR & 0x80) == 0) {
  }
  USART2->DR = (uint16_t)c & 0x1FF;
}

static void cycles_on(void) {
  DEMCR |= 1u << 24;
  DWT_CYCCNT = 0;
  DWT_CTRL |= 1;
}

static void wait_cycles(uint32_t cycles) {
  const uint32_t start = DWT_CYCCNT;
  while (DWT_CYCCNT - start < cycles) {
  }
}

/* DMA_Init for memory to memory on DMA2 stream 1, then DMA_GetFlagStatus. */
static void copy_by_dma(void) {
  RCC->AHB1ENR |= 1u << 22;
  for (uint32_t i = 0; i < 64; ++i) words[i] = i * 0x01010101u;
  dma_stream_t* stream = &DMA2->S[1];
  stream->CR &= ~1u;
  while ((stream->CR & 1) != 0) {
  }
  stream->PAR = (uint32_t)(uintptr_t)words;
  stream->M0AR = (uint32_t)(uintptr_t)copied;
  stream->NDTR = 64;
  stream->FCR = 1u << 2 | 3;
  stream->CR = 2u << 6 | 1u << 9 | 1u << 10 | 2u << 11 | 2u << 13 | 2u << 16;
  stream->CR |= 1;
  while ((DMA2->LISR & 1u << 11) == 0) {
  }
  DMA2->LIFCR = 1u << 11;
  uint32_t right = 0;
  for (uint32_t i = 0; i < 64; ++i) right += copied[i] == i * 0x01010101u;
  say("dma_words", right);
}

/* ADC_CommonInit for dual regular simultaneous mode, DMA mode 2, triggered by TIM2's TRGO. */
static void dual_adc(void) {
  RCC->APB2ENR |= 3u << 8;
  RCC->APB1ENR |= 1;
  pin_mode(GPIOA, 1, 3, 0);
  pin_mode(GPIOA, 4, 3, 0);
  TIM2->PSC = 0;
  TIM2->ARR = 8399;
  TIM2->EGR = 1;
  TIM2->CR2 = 2u << 4;
  ADC_CCR = 6 | 1u << 16 | 2u << 14 | 1u << 13;
  ADC1->SMPR2 = 1u << 3;
  ADC2->SMPR2 = 1u << 12;
  ADC1->SQR3 = 1;
  ADC2->SQR3 = 4;
  ADC1->CR2 = 6u << 24 | 1u << 28;
  ADC2->CR2 = 0;
  dma_stream_t* stream = &DMA2->S[0];
  stream->CR = 0;
  stream->PAR = ADC_CDR_ADDRESS;
  stream->M0AR = (uint32_t)(uintptr_t)words;
  stream->NDTR = 8;
  stream->CR = 1u << 10 | 2u << 11 | 2u << 13 | 1u << 8;
  stream->CR |= 1;
  ADC1->CR2 |= 1;
  ADC2->CR2 |= 1;
  const uint32_t start = DWT_CYCCNT;
  TIM2->CR1 |= 1;
  for (int i = 0; i < 8; ++i) words[i] = 0;
  while ((DMA2->LISR & 1u << 5) == 0) {
  }
  say("adc_eight_us", (DWT_CYCCNT - start) / 168);
  TIM2->CR1 &= ~1u;
  say("adc1", words[7] & 0xFFFF);
  say("adc2", words[7] >> 16);
}

/* TIM_BDTRConfig and complementary outputs: the pins themselves say what they do. */
static void complementary(void) {
  RCC->APB2ENR |= 1u << 1;
  pin_mode(GPIOC, 6, 2, 3);
  pin_mode(GPIOA, 7, 2, 3);
  TIM8->ARR = 16799; /* 100 us */
  TIM8->PSC = 0;
  TIM8->RCR = 0;
  TIM8->EGR = 1;
  TIM8->CCMR1 = 0x60;
  TIM8->CCR1 = 8400;
  TIM8->CCER = 5;
  TIM8->BDTR = 0xD2 | 1u << 11 | 1u << 10 | 1u << 15; /* (32 + 18) * 8 clocks: 2.38 us */
  TIM8->CR1 |= 1;
  uint32_t count[4] = {0, 0, 0, 0}; /* no branches: each sample takes the same time */
  const uint32_t start = DWT_CYCCNT;
  while (DWT_CYCCNT - start < 168 * 5000) {
    ++count[(GPIOC->IDR >> 6 & 1) << 1 | (GPIOA->IDR >> 7 & 1)];
  }
  const uint32_t all = count[0] + count[1] + count[2] + count[3];
  say("main_permille", count[2] * 1000 / all);
  say("complement_permille", count[1] * 1000 / all);
  say("shoot_through", count[3]);
  TIM8->EGR = 0x80; /* break */
  say("moe_after_break", TIM8->BDTR >> 15 & 1);
}

/* DMA burst: one update event loads three compare registers. */
static void timer_burst(void) {
  RCC->APB1ENR |= 1u << 1;
  RCC->AHB1ENR |= 1u << 21;
  dma_stream_t* stream = &DMA1->S[2]; /* TIM3_UP, channel 5 */
  stream->CR = 0;
  stream->PAR = (uint32_t)(uintptr_t)&TIM3->DMAR;
  stream->M0AR = (uint32_t)(uintptr_t)burst;
  stream->NDTR = 3;
  stream->CR = 5u << 25 | 2u << 13 | 2u << 11 | 1u << 10 | 1u << 6;
  stream->CR |= 1;
  TIM3->ARR = 839;
  TIM3->DCR = 2u << 8 | 13;
  TIM3->DIER = 1u << 8;
  TIM3->CR1 = 1;
  wait_cycles(168 * 20);
  say("burst_ccr", TIM3->CCR1);
  say("burst_ccr", TIM3->CCR2);
  say("burst_ccr", TIM3->CCR3);
  TIM3->CR1 = 0;
}

void EXTI0_Handler(void) {
  if ((EXTI_PR & 1) != 0) {
    edge_cycles = DWT_CYCCNT;
    ++edges;
    EXTI_PR = 1;
  }
}

static void exti(void) {
  RCC->APB2ENR |= 1u << 14;
  pin_mode(GPIOA, 0, 0, 0);
  pin_mode(GPIOC, 0, 1, 0);
  SYSCFG_EXTICR(0) &= ~0xFu;
  EXTI_IMR |= 1;
  EXTI_RTSR |= 1;
  NVIC_ISER(0) = 1u << 6;
  uint32_t slowest = 0;
  for (int i = 0; i < 5; ++i) {
    const uint32_t raised = DWT_CYCCNT;
    GPIOC->BSRR = 1;
    wait_cycles(168);
    GPIOC->BSRR = 1u << 16;
    wait_cycles(168);
    if (edge_cycles - raised > slowest) slowest = edge_cycles - raised;
  }
  say("exti_edges", edges);
  say("exti_prompt", slowest < 168);
}

/* I2C_CheckEvent against an empty bus: no acknowledge, then a clean bus again. */
static void i2c_nobody(void) {
  RCC->APB1ENR |= 1u << 21;
  pin_mode(GPIOB, 6, 2, 4);
  pin_mode(GPIOB, 7, 2, 4);
  GPIOB->OTYPER |= 3u << 6;
  GPIOB->PUPDR |= 5u << 12;
  I2C1->CR2 = 42;
  I2C1->CR1 &= ~1u;
  I2C1->TRISE = 43;
  I2C1->CCR = 210;
  I2C1->CR1 |= 1;
  I2C1->CR1 |= 1u << 8;
  uint32_t n = 0;
  while ((I2C1->SR1 & 1) == 0 && ++n < 100000) {
  }
  I2C1->DR = 0x52 << 1;
  n = 0;
  while ((I2C1->SR1 & (1u << 10 | 2)) == 0 && ++n < 100000) {
  }
  say("i2c_af", I2C1->SR1 >> 10 & 1);
  I2C1->SR1 = (uint16_t) ~(1u << 10);
  I2C1->CR1 |= 1u << 9;
  n = 0;
  while ((I2C1->SR2 & 2) != 0 && ++n < 100000) {
  }
  say("i2c_free", n < 100000);
}

static void dac(void) {
  RCC->APB1ENR |= 1u << 29 | 1u << 4;
  TIM6->PSC = 0;
  TIM6->ARR = 839;
  TIM6->CR2 = 2u << 4;
  DAC_CR = 1u << 2 | 0u << 3; /* triggered by TIM6 */
  DAC_CR |= 1;
  DAC_DHR12R1 = 1234;
  say("dac_before", DAC_DOR1);
  TIM6->CR1 |= 1;
  wait_cycles(168 * 30);
  say("dac_after", DAC_DOR1);
}

int main(void) {
  system_init();
  usart_init();
  cycles_on();
  copy_by_dma();
  dual_adc();
  complementary();
  timer_burst();
  exti();
  i2c_nobody();
  dac();
  say("done", 1);
  for (;;) wait_for_interrupt();
}

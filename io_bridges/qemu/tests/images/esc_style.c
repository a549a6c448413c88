/* What a six-step motor controller on an STM32F103CB asks of the part, in the manner of the Standard
   Peripheral Library: PWM on TIM4, both converters at once by DMA, an injected group by a timer,
   PWM input on TIM1, stored calibration in flash, bit-band switches, faults beyond the memories.
   Board: 12 MHz crystal, 0.55, 1.1, 1.65 and 2.2 V on PA1 to PA4, jumpers from PB6 to PA8 and from
   PB12 to PB13, a terminal on USART1. */
#include <stdint.h>

typedef volatile uint32_t reg32;
#define REG(address) (*(reg32*)(address))
#define RCC(offset) REG(0x40021000 + (offset))
#define FLASH(offset) REG(0x40022000 + (offset))
#define GPIOA(offset) REG(0x40010800 + (offset))
#define GPIOB(offset) REG(0x40010C00 + (offset))
#define AFIO(offset) REG(0x40010000 + (offset))
#define EXTI(offset) REG(0x40010400 + (offset))
#define USART1(offset) REG(0x40013800 + (offset))
#define TIM1(offset) REG(0x40012C00 + (offset))
#define TIM2(offset) REG(0x40000000 + (offset))
#define TIM4(offset) REG(0x40000800 + (offset))
#define ADC1(offset) REG(0x40012400 + (offset))
#define ADC2(offset) REG(0x40012800 + (offset))
#define DMA1(offset) REG(0x40020000 + (offset))
#define PWR_CR REG(0x40007000)
#define BKP(n) REG(0x40006C00 + 4 * (n))
#define CAN(offset) REG(0x40006400 + (offset))
#define ISER(n) REG(0xE000E100 + 4 * (n))
#define DWT_CYCCNT REG(0xE0001004)
enum {
  CR1,
  CR2 = 4,
  SMCR = 8,
  DIER = 12,
  SR = 16,
  EGR = 20,
  CCMR1 = 24,
  CCMR2 = 28,
  CCER = 32,
  CNT = 36,
  PSC = 40,
  ARR = 44,
  CCR1 = 52,
  CCR2 = 56,
  CCR3 = 60
};

static uint32_t words[32]; /* ADC2 above, ADC1 below */
static volatile uint32_t halves, fulls, injected, injected_sum, edges, edge_cycles, faults;
static volatile uint32_t half_at, full_at;

extern uint32_t bss_start[], bss_end[], stack_top[];

static void send(char c) {
  while ((USART1(0) & 0x80) == 0) {
  }
  USART1(4) = (uint32_t)c;
}

static void say(const char* name, uint32_t value) {
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

static void wait_cycles(uint32_t cycles) {
  const uint32_t start = DWT_CYCCNT;
  while (DWT_CYCCNT - start < cycles) {
  }
}

static void rcc_configuration(void) {
  RCC(0) |= 1u << 16;
  while ((RCC(0) & 1u << 17) == 0) {
  }
  FLASH(0) = 0x12;
  RCC(4) = 4u << 18 | 1u << 16 | 4u << 8 | 2u << 14; /* HSE * 6, PCLK1 / 2, ADC / 6: 12 MHz */
  RCC(0) |= 1u << 24;
  while ((RCC(0) & 1u << 25) == 0) {
  }
  RCC(4) |= 2;
  while ((RCC(4) & 0xC) != 8) {
  }
  RCC(0x14) |= 1 | 1u << 6;
  RCC(0x18) |= 1 | 3u << 2 | 3u << 9 | 1u << 11 | 1u << 14;
  RCC(0x1C) |= 5 | 1u << 25 | 3u << 27;
}

static void gpio_configuration(void) {
  AFIO(4) |= 2u << 24;                                     /* JTAG off, SWD on */
  GPIOA(0) = 0x44400004;                                   /* PA1 to PA4 analog */
  GPIOA(4) = (GPIOA(4) & 0xFFFFF000) | 0x4B4;              /* PA9 TX, PA8 in */
  GPIOB(0) = (GPIOB(0) & 0x00FFFFFF) | 0xBB000000;         /* PB6, PB7 PWM */
  GPIOB(4) = (GPIOB(4) & 0xFF00FFF0) | 0x00430000 | 0x00B; /* PB8 PWM, PB12 out, PB13 in */
  USART1(8) = 72000000 / 115200;
  USART1(12) = 0x2008;
}

/* Bit-band alias of a peripheral register's bit, as motor controllers switch their low sides. */
#define BIT_BAND(address, bit) REG(0x42000000 + ((address)-0x40000000) * 32 + (bit)*4)

static void bit_band(void) {
  BIT_BAND(0x40010C0C, 12) = 1;
  say("bit_band_set", GPIOB(12) >> 12 & 1);
  say("bit_band_read", BIT_BAND(0x40010C08, 13)); /* IDR of the jumper's other end */
  BIT_BAND(0x40010C0C, 12) = 0;
  say("bit_band_clear", GPIOB(12) >> 12 & 1);
}

/* 20 kHz on three phases, the duty of each preloaded; measured back through PA8. */
static void pwm(void) {
  TIM4(PSC) = 0;
  TIM4(ARR) = 3599;
  TIM4(CCMR1) = 0x6868;
  TIM4(CCMR2) = 0x68;
  TIM4(CCR1) = 900;
  TIM4(CCR2) = 1800;
  TIM4(CCR3) = 2700;
  TIM4(CCER) = 0x111;
  TIM4(CR1) = 0x80;
  TIM4(EGR) = 1;
  TIM4(CR1) |= 1;
  TIM1(PSC) = 0;
  TIM1(ARR) = 0xFFFF;
  TIM1(CCMR1) = 0x0201;
  TIM1(CCER) = 0x31;
  TIM1(SMCR) = 0x54;
  TIM1(CR1) = 1;
  wait_cycles(72 * 500);
  say("pwm_period", TIM1(CCR1));
  say("pwm_high", TIM1(CCR2));
  TIM4(CCMR1) = (TIM4(CCMR1) & ~0x70u) | 0x40; /* phase A forced low: takes effect at once */
  wait_cycles(72 * 5);
  say("forced_low", GPIOB(8) >> 6 & 1);
  TIM4(CCMR1) = (TIM4(CCMR1) & ~0x70u) | 0x50;
  wait_cycles(72);
  say("forced_high", GPIOB(8) >> 6 & 1);
  TIM4(CCMR1) = (TIM4(CCMR1) & ~0x70u) | 0x60;
}

static void calibrate(uint32_t adc) {
  REG(adc + 8) |= 8;
  while ((REG(adc + 8) & 8) != 0) {
  }
  REG(adc + 8) |= 4;
  while ((REG(adc + 8) & 4) != 0) {
  }
}

void dma1_channel1_handler(void) {
  if ((DMA1(0) & 4) != 0) {
    DMA1(4) = 4;
    half_at = DWT_CYCCNT;
    ++halves;
  }
  if ((DMA1(0) & 2) != 0) {
    DMA1(4) = 2;
    full_at = DWT_CYCCNT;
    ++fulls;
  }
}

void adc_handler(void) {
  if ((ADC1(0) & 4) != 0) {
    ADC1(0) = ~4u;
    injected_sum += ADC1(0x3C);
    ++injected;
  }
}

/* ADC_Mode_RegInjecSimult, continuous scan of two channels each, DMA in words; JEXTSEL = TIM2_CC1. */
static void adc(void) {
  DMA1(0x10) = 0x4001244C;
  DMA1(0x14) = (uint32_t)(uintptr_t)words;
  DMA1(0x0C) = 32;
  DMA1(0x08) = 3u << 12 | 2u << 10 | 2u << 8 | 1u << 7 | 1u << 5 | 3u << 1;
  DMA1(0x08) |= 1;
  ISER(0) = 1u << 11 | 1u << 18;
  for (uint32_t adc = 0x40012400; adc <= 0x40012800; adc += 0x400) {
    REG(adc + 4) = 1u << 8;
    REG(adc + 0x10) = 3u << 3 | 3u << 6 | 3u << 9 | 3u << 12; /* 28.5 clocks */
    REG(adc + 0x2C) = 1u << 20;
    REG(adc + 8) = 1u << 1 | 1u << 20 | 7u << 17;
  }
  ADC1(4) |= 1u << 16;
  ADC1(0x34) = 1 | 3u << 5;
  ADC2(0x34) = 2 | 4u << 5;
  ADC1(0x38) = 1u << 15;
  ADC2(0x38) = 2u << 15;
  ADC1(8) |= 1u << 8;
  ADC1(8) |= 1;
  ADC2(8) |= 1;
  const uint32_t start = DWT_CYCCNT;
  calibrate(0x40012400);
  say("calibration_right", DWT_CYCCNT - start >= 84 * 6 && DWT_CYCCNT - start < 200 * 6);
  calibrate(0x40012800);
  ADC1(8) |= 1u << 20 | 1u << 22;
  while (fulls < 3) {
  }
  const uint32_t from = full_at;
  while (fulls < 13) {
  }
  say("ten_buffers_cycles", (full_at - from + 50) / 100);
  say("half_before_full", halves >= fulls);
  say("adc1_first", words[30] & 0xFFFF);
  say("adc1_second", words[31] & 0xFFFF);
  say("adc2_first", words[30] >> 16);
  say("adc2_second", words[31] >> 16);

  ADC1(4) |= 1u << 7; /* JEOCIE */
  ADC1(8) = (ADC1(8) & ~(7u << 12)) | 3u << 12 | 1u << 15;
  ADC2(8) = (ADC2(8) & ~(7u << 12)) | 7u << 12 | 1u << 15;
  TIM2(PSC) = 71;
  TIM2(ARR) = 99;
  TIM2(CCMR1) = 0x70;
  TIM2(CCR1) = 50;
  TIM2(CCER) = 1;
  TIM2(EGR) = 1;
  TIM2(CR1) = 1;
  wait_cycles(72 * 1010);
  TIM2(CR1) = 0;
  say("injected", injected);
  say("injected_mean", injected_sum / injected);
  say("injected_partner", ADC2(0x3C));
  ADC1(8) = 0;
  ADC2(8) = 0;
}

void exti15_10_handler(void) {
  if ((EXTI(0x14) & 1u << 13) != 0) {
    EXTI(0x14) = 1u << 13;
    edge_cycles = DWT_CYCCNT;
    ++edges;
  }
}

static void exti(void) {
  AFIO(0x14) = 1u << 4; /* line 13: port B */
  EXTI(0) |= 1u << 13;
  EXTI(8) |= 1u << 13;
  EXTI(12) |= 1u << 13;
  ISER(1) = 1u << 8;
  const uint32_t raised = DWT_CYCCNT;
  GPIOB(0x10) = 1u << 12;
  wait_cycles(100);
  say("exti_prompt", edge_cycles - raised < 100);
  GPIOB(0x14) = 1u << 12;
  wait_cycles(100);
  say("exti_edges", edges);
}

/* FLASH_ErasePage, FLASH_ProgramHalfWord on the last page. */
static void flash(void) {
  const uint32_t page = 0x0801FC00;
  FLASH(4) = 0x45670123;
  FLASH(4) = 0xCDEF89AB;
  FLASH(0x10) |= 2;
  FLASH(0x14) = page;
  FLASH(0x10) |= 0x40;
  while ((FLASH(0x0C) & 1) != 0) {
  }
  FLASH(0x10) &= ~2u;
  say("flash_erased", REG(page) == 0xFFFFFFFF);
  FLASH(0x10) |= 1;
  *(volatile uint16_t*)(uintptr_t)page = 0x1234;
  while ((FLASH(0x0C) & 1) != 0) {
  }
  *(volatile uint16_t*)(uintptr_t)(page + 2) = 0x5678;
  while ((FLASH(0x0C) & 1) != 0) {
  }
  FLASH(0x10) &= ~1u;
  FLASH(0x10) |= 0x80;
  say("flash_word", REG(page));
}

/* A read that nothing answers: the handler steps over the two-byte load. */
void fault_handler_c(uint32_t* frame) {
  ++faults;
  frame[6] += 2;
  REG(0xE000ED28) = 0xFFFFFFFF;
}

__attribute__((naked)) void fault_handler(void) {
  __asm volatile("mov r0, sp\n b fault_handler_c");
}

static uint32_t faulting_read(uint32_t address) {
  const uint32_t before = faults;
  register uint32_t at __asm("r1") = address;
  register uint32_t to __asm("r2") = 0;
  __asm volatile(".inst.n 0x680a" : "+r"(to) : "r"(at) : "memory"); /* ldr r2, [r1] */
  return faults - before;
}

static void limits(void) {
  say("inside_flash", faulting_read(0x0801FFFC));
  say("beyond_flash", faulting_read(0x08020000));
  say("inside_sram", faulting_read(0x20004FFC));
  say("beyond_sram", faulting_read(0x20005000));
}

static void rest(void) {
  PWR_CR |= 1u << 8;
  BKP(1) = 0x5AA5;
  say("backup", BKP(1));
  say("flash_KiB", *(volatile uint16_t*)0x1FFFF7E0);
  say("device_id", REG(0xE0042000) & 0xFFF);
  CAN(0) = (CAN(0) & ~2u) | 1;
  say("can_init", CAN(4) & 3);
}

int main(void) {
  rcc_configuration();
  gpio_configuration();
  REG(0xE000EDFC) |= 1u << 24;
  REG(0xE0001000) |= 1;
  bit_band();
  pwm();
  adc();
  exti();
  flash();
  limits();
  rest();
  say("done", 1);
  for (;;) __asm volatile("wfi");
}

void reset_handler(void) {
  for (uint32_t* to = bss_start; to != bss_end;) *to++ = 0;
  main();
}

static void unexpected(void) {
  for (;;) {
  }
}

typedef void (*vector)(void);
__attribute__((section(".vectors"), used))
const vector vectors[16 + 43] = {(vector)stack_top,
                                 reset_handler,
                                 unexpected,
                                 fault_handler,
                                 fault_handler,
                                 fault_handler,
                                 fault_handler,
                                 0,
                                 0,
                                 0,
                                 0,
                                 unexpected,
                                 unexpected,
                                 0,
                                 unexpected,
                                 unexpected,
                                 [16 + 11] = dma1_channel1_handler,
                                 [16 + 18] = adc_handler,
                                 [16 + 40] = exti15_10_handler};

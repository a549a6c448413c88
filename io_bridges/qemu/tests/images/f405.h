/* STM32F405 registers that the driver-style images use (RM0090), and what each image gives. */
#pragma once
#include <stddef.h>
#include <stdint.h>

typedef volatile uint32_t reg32;
#define REG(address) (*(reg32*)(address))

typedef struct {
  reg32 CR, PLLCFGR, CFGR, CIR, AHB1RSTR, AHB2RSTR, AHB3RSTR, r0, APB1RSTR, APB2RSTR, r1[2],
      AHB1ENR, AHB2ENR, AHB3ENR, r2, APB1ENR, APB2ENR, r3[2], AHB1LPENR, AHB2LPENR, AHB3LPENR, r4,
      APB1LPENR, APB2LPENR, r5[2], BDCR, CSR;
} rcc_t;
typedef struct {
  reg32 MODER, OTYPER, OSPEEDR, PUPDR, IDR, ODR, BSRR, LCKR, AFR[2];
} gpio_t;
typedef struct {
  reg32 SR, DR, BRR, CR1, CR2, CR3, GTPR;
} usart_t;
typedef struct {
  reg32 CR1, CR2, SMCR, DIER, SR, EGR, CCMR1, CCMR2, CCER, CNT, PSC, ARR, RCR, CCR1, CCR2, CCR3,
      CCR4, BDTR, DCR, DMAR, OR;
} tim_t;
typedef struct {
  reg32 SR, CR1, CR2, SMPR1, SMPR2, JOFR[4], HTR, LTR, SQR1, SQR2, SQR3, JSQR, JDR[4], DR;
} adc_t;
typedef struct {
  reg32 CR, NDTR, PAR, M0AR, M1AR, FCR;
} dma_stream_t;
typedef struct {
  reg32 LISR, HISR, LIFCR, HIFCR;
  dma_stream_t S[8];
} dma_t;
typedef struct {
  reg32 TR, DR, CR, ISR, PRER, WUTR, CALIBR, ALRMAR, ALRMBR, WPR, SSR, SHIFTR, TSTR, TSDR, TSSSR,
      CALR, TAFCR, ALRMASSR, ALRMBSSR, r0, BKP[20];
} rtc_t;
typedef struct {
  reg32 CR1, CR2, OAR1, OAR2, DR, SR1, SR2, CCR, TRISE;
} i2c_t;

#define RCC ((rcc_t*)0x40023800)
#define GPIOA ((gpio_t*)0x40020000)
#define GPIOB ((gpio_t*)0x40020400)
#define GPIOC ((gpio_t*)0x40020800)
#define USART2 ((usart_t*)0x40004400)
#define TIM1 ((tim_t*)0x40010000)
#define TIM2 ((tim_t*)0x40000000)
#define TIM3 ((tim_t*)0x40000400)
#define TIM4 ((tim_t*)0x40000800)
#define TIM5 ((tim_t*)0x40000C00)
#define TIM6 ((tim_t*)0x40001000)
#define TIM8 ((tim_t*)0x40010400)
#define ADC1 ((adc_t*)0x40012000)
#define ADC2 ((adc_t*)0x40012100)
#define ADC_CCR REG(0x40012304)
#define ADC_CDR_ADDRESS 0x40012308u
#define DMA1 ((dma_t*)0x40026000)
#define DMA2 ((dma_t*)0x40026400)
#define RTC ((rtc_t*)0x40002800)
#define I2C1 ((i2c_t*)0x40005400)
#define FLASH_ACR REG(0x40023C00)
#define PWR_CR REG(0x40007000)
#define PWR_CSR REG(0x40007004)
#define CRC_DR REG(0x40023000)
#define CRC_CR REG(0x40023008)
#define RNG_CR REG(0x50060800)
#define RNG_SR REG(0x50060804)
#define RNG_DR REG(0x50060808)
#define IWDG_KR REG(0x40003000)
#define IWDG_PR REG(0x40003004)
#define IWDG_RLR REG(0x40003008)
#define IWDG_SR REG(0x4000300C)
#define DAC_CR REG(0x40007400)
#define DAC_DHR12R1 REG(0x40007408)
#define DAC_DOR1 REG(0x4000742C)
#define CAN(offset) REG(0x40006400 + (offset))
#define SYSCFG_EXTICR(n) REG(0x40013808 + 4 * (n))
#define EXTI_IMR REG(0x40013C00)
#define EXTI_RTSR REG(0x40013C08)
#define EXTI_PR REG(0x40013C14)
#define SYSTICK_CTRL REG(0xE000E010)
#define SYSTICK_LOAD REG(0xE000E014)
#define SYSTICK_VAL REG(0xE000E018)
#define NVIC_ISER(n) REG(0xE000E100 + 4 * (n))
#define NVIC_IPR(irq) (*(volatile uint8_t*)(0xE000E400 + (irq)))
#define DWT_CTRL REG(0xE0001000)
#define DWT_CYCCNT REG(0xE0001004)
#define DEMCR REG(0xE000EDFC)

int main(void);
void say(const char* name, uint32_t value); /* "name value\n" through the image's own send() */
void clock_168_MHz(void);                   /* from a crystal of 8 MHz; DWT counts from 0 */
void send(char c);                          /* each image's own UART driver */

#define wait_for_interrupt() __asm volatile("wfi" ::: "memory")
#define disable_interrupts() __asm volatile("cpsid i" ::: "memory")
#define enable_interrupts() __asm volatile("cpsie i" ::: "memory")

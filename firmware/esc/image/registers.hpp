// STM32F103CB as the ESC's image sees it: every address and the bits that are used.
//
//   Names   registers and bits keep the spelling of the reference manual
//   Source  RM0008 (register maps at the end of each chapter); PM0056 for the core
#pragma once
#include <cstdint>

#include "firmware/hal/core_registers.hpp"

namespace fw::f103 {

using hw::bit;
using hw::IWDG;
using hw::Reg32;

struct RCC {
  static constexpr std::uint32_t base = 0x4002'1000;
  using CR = Reg32<base + 0x00>;
  using CFGR = Reg32<base + 0x04>;
  using AHBENR = Reg32<base + 0x14>;
  using APB2ENR = Reg32<base + 0x18>;
  using APB1ENR = Reg32<base + 0x1C>;
  using CSR = Reg32<base + 0x24>;
  static constexpr std::uint32_t HSEON = bit(16), HSERDY = bit(17), PLLON = bit(24),
                                 PLLRDY = bit(25);
  static constexpr std::uint32_t SW_PLL = 2u, SWS_Msk = 3u << 2, SWS_PLL = 2u << 2;
  static constexpr std::uint32_t PPRE1_DIV2 = 4u << 8, ADCPRE_DIV6 = 2u << 14, PLLSRC_HSE = bit(16),
                                 PLLMUL9 = 7u << 18;
  static constexpr std::uint32_t AFIOEN = bit(0), IOPAEN = bit(2), IOPBEN = bit(3), ADC1EN = bit(9),
                                 ADC2EN = bit(10), TIM1EN = bit(11), USART1EN = bit(14);
  static constexpr std::uint32_t DMA1EN = bit(0);
  static constexpr std::uint32_t TIM2EN = bit(0), TIM4EN = bit(2), I2C2EN = bit(22),
                                 CANEN = bit(25);
};

struct UID {  // 96 bits, each part's own
  static constexpr std::uint32_t base = 0x1FFF'F7E8;
};

// bxCAN; its registers: hal/bxcan_registers.hpp. PA11 and PA12 are its pins without remap.
using CAN = hw::RegBlock<0x4000'6400>;

struct FLASH {
  static constexpr std::uint32_t base = 0x4002'2000;
  using ACR = Reg32<base + 0x00>;
  using KEYR = Reg32<base + 0x04>;
  using SR = Reg32<base + 0x0C>;
  using CR = Reg32<base + 0x10>;
  using AR = Reg32<base + 0x14>;
  static constexpr std::uint32_t LATENCY_2WS = 2u, PRFTBE = bit(4);
  static constexpr std::uint32_t KEY1 = 0x4567'0123, KEY2 = 0xCDEF'89AB;
  static constexpr std::uint32_t BSY = bit(0), PGERR = bit(2), WRPRTERR = bit(4), EOP = bit(5);
  static constexpr std::uint32_t PG = bit(0), PER = bit(1), STRT = bit(6), LOCK = bit(7);
};

template <std::uint32_t kBase>
struct Gpio {
  using CRL = Reg32<kBase + 0x00>;
  using CRH = Reg32<kBase + 0x04>;
  using IDR = Reg32<kBase + 0x08>;
  using BSRR = Reg32<kBase + 0x10>;
  // One nibble per pin: CNF << 2 | MODE.
  static void configure(unsigned pin, std::uint32_t nibble) {
    const unsigned shift = 4 * (pin % 8);
    if (pin < 8) {
      CRL::replace(0xFu << shift, nibble << shift);
    } else {
      CRH::replace(0xFu << shift, nibble << shift);
    }
  }
};
inline constexpr std::uint32_t kAnalog = 0x0, kInputFloating = 0x4, kInputPull = 0x8, kOutput = 0x3,
                               kOutputSlow = 0x2, kAlternate = 0xB, kAlternateOpenDrain = 0xF;
using GPIOA = Gpio<0x4001'0800>;
using GPIOB = Gpio<0x4001'0C00>;

struct AFIO {
  using MAPR = Reg32<0x4001'0004>;
  static constexpr std::uint32_t SWJ_JTAG_OFF = 2u << 24;  // frees PB3 and PB4, keeps SWD
};

template <std::uint32_t kBase>
struct Timer {
  using CR1 = Reg32<kBase + 0x00>;
  using CR2 = Reg32<kBase + 0x04>;
  using SMCR = Reg32<kBase + 0x08>;
  using DIER = Reg32<kBase + 0x0C>;
  using SR = Reg32<kBase + 0x10>;
  using EGR = Reg32<kBase + 0x14>;
  using CCMR1 = Reg32<kBase + 0x18>;
  using CCMR2 = Reg32<kBase + 0x1C>;
  using CCER = Reg32<kBase + 0x20>;
  using CNT = Reg32<kBase + 0x24>;
  using PSC = Reg32<kBase + 0x28>;
  using ARR = Reg32<kBase + 0x2C>;
  using CCR1 = Reg32<kBase + 0x34>;
  using CCR2 = Reg32<kBase + 0x38>;
  using CCR3 = Reg32<kBase + 0x3C>;
  using CCR4 = Reg32<kBase + 0x40>;
  static constexpr std::uint32_t CEN = bit(0), ARPE = bit(7), UG = bit(0), CC1G = bit(1),
                                 CC1IE = bit(1), CC1IF = bit(1);
  static constexpr std::uint32_t MMS_OC4REF = 7u << 4;
  static constexpr std::uint32_t OC1M_PWM1 = 6u << 4, OC1PE = bit(3), OC2M_PWM1 = 6u << 12,
                                 OC2PE = bit(11);
  static constexpr std::uint32_t OC3M_PWM1 = 6u << 4, OC3PE = bit(3), OC4M_PWM2 = 7u << 12,
                                 OC4PE = bit(11);
  static constexpr std::uint32_t CC1E = bit(0), CC2E = bit(4), CC3E = bit(8), CC4E = bit(12);
  // PWM input: both captures look at TI1, channel 2 at its falling edge.
  static constexpr std::uint32_t UIF = bit(0), CC2IF = bit(2), CC1OF = bit(9), CC2OF = bit(10),
                                 URS = bit(2), CKD_DIV4 = 2u << 8, CC2P = bit(5);
  static constexpr std::uint32_t CC1S_TI1 = 1u, CC2S_TI1 = 2u << 8, IC1F_LONGEST = 15u << 4,
                                 IC2F_LONGEST = 15u << 12;
  static constexpr std::uint32_t TS_TI1FP1 = 5u << 4, SMS_RESET = 4u;
};
using TIM1 = Timer<0x4001'2C00>;
using TIM2 = Timer<0x4000'0000>;
using TIM4 = Timer<0x4000'0800>;

template <std::uint32_t kBase>
struct Adc {
  using SR = Reg32<kBase + 0x00>;
  using CR1 = Reg32<kBase + 0x04>;
  using CR2 = Reg32<kBase + 0x08>;
  using SMPR2 = Reg32<kBase + 0x10>;
  using JSQR = Reg32<kBase + 0x38>;
  using JDR1 = Reg32<kBase + 0x3C>;
  using JDR2 = Reg32<kBase + 0x40>;
  static constexpr std::uint32_t JEOC = bit(2), JEOCIE = bit(7), SCAN = bit(8),
                                 DUALMOD_INJECTED = 5u << 16;
  static constexpr std::uint32_t ADON = bit(0), CAL = bit(2), RSTCAL = bit(3),
                                 JEXTSEL_TIM4_TRGO = 5u << 12, JEXTSEL_JSWSTART = 7u << 12,
                                 JEXTTRIG = bit(15);
};
using ADC1 = Adc<0x4001'2400>;
using ADC2 = Adc<0x4001'2800>;

struct I2C2 {
  static constexpr std::uint32_t base = 0x4000'5800;
  using CR1 = Reg32<base + 0x00>;
  using CR2 = Reg32<base + 0x04>;
  using OAR1 = Reg32<base + 0x08>;
  using DR = Reg32<base + 0x10>;
  using SR1 = Reg32<base + 0x14>;
  using SR2 = Reg32<base + 0x18>;
  using CCR = Reg32<base + 0x1C>;
  using TRISE = Reg32<base + 0x20>;
  static constexpr std::uint32_t PE = bit(0), ACK = bit(10), SWRST = bit(15);
  static constexpr std::uint32_t ITERREN = bit(8), ITEVTEN = bit(9), ITBUFEN = bit(10);
  static constexpr std::uint32_t ADDR = bit(1), STOPF = bit(4), RXNE = bit(6), TXE = bit(7),
                                 BERR = bit(8), ARLO = bit(9), AF = bit(10), OVR = bit(11);
  static constexpr std::uint32_t BUSY = bit(1), TRA = bit(2);
};

struct USART1 {
  static constexpr std::uint32_t base = 0x4001'3800;
  using DR = Reg32<base + 0x04>;
  using BRR = Reg32<base + 0x08>;
  using CR1 = Reg32<base + 0x0C>;
  using CR3 = Reg32<base + 0x14>;
  static constexpr std::uint32_t RE = bit(2), TE = bit(3), UE = bit(13);
  static constexpr std::uint32_t DMAR = bit(6), DMAT = bit(7);
};

struct DMA1 {
  static constexpr std::uint32_t base = 0x4002'0000;
  using IFCR = Reg32<base + 0x04>;
};

template <unsigned kChannel>
struct DmaChannel {
  static constexpr std::uint32_t base = DMA1::base + 0x08 + 0x14 * (kChannel - 1);
  using CCR = Reg32<base + 0x00>;
  using CNDTR = Reg32<base + 0x04>;
  using CPAR = Reg32<base + 0x08>;
  using CMAR = Reg32<base + 0x0C>;
  static constexpr std::uint32_t EN = bit(0), TCIE = bit(1), DIR = bit(4), CIRC = bit(5),
                                 MINC = bit(7);
  static constexpr std::uint32_t CGIF = bit(4 * (kChannel - 1));
};
using SerialOut = DmaChannel<4>;  // requests of USART1: RM0008 table 78
using SerialIn = DmaChannel<5>;

struct SysTick {
  using CTRL = Reg32<0xE000'E010>;
  using LOAD = Reg32<0xE000'E014>;
  using VAL = Reg32<0xE000'E018>;
  using SHPR3 = Reg32<0xE000'ED20>;
  static constexpr std::uint32_t ENABLE = bit(0), TICKINT = bit(1), CLKSOURCE = bit(2);
};

enum class Irq : std::uint8_t {
  DMA1_Channel4 = 14,
  ADC1_2 = 18,
  CAN_TX = 19,
  CAN_RX0 = 20,
  CAN_SCE = 22,
  TIM2_Global = 28,
  I2C2_EV = 33,
  I2C2_ER = 34
};
inline constexpr unsigned kIrqCount = 43;

template <Irq kIrq>
using Nvic = hw::NvicLine<static_cast<unsigned>(kIrq)>;

enum Priority : std::uint32_t {
  kPriorityCommutation = 0,
  kPrioritySampling = 1,
  kPriorityI2c = 2,
  kPriorityCan = 2,
  kPrioritySerial = 4,
  kPriorityControl = 3,
};

}  // namespace fw::f103

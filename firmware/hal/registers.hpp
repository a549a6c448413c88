// STM32F405 as the firmware sees it: every hardware address, and the bits that are used.
//
//   Names   registers and bits keep the spelling of the reference manual
//   Source  RM0090 (memory map 2.3, register maps at the end of each chapter); PM0214 for the core
#pragma once
#include <array>
#include <cstdint>

#include "firmware/hal/core_registers.hpp"

namespace fw::hw {

struct RCC {
  static constexpr std::uint32_t base = 0x4002'3800;
  using CR = Reg32<base + 0x00>;
  using PLLCFGR = Reg32<base + 0x04>;
  using CFGR = Reg32<base + 0x08>;
  using APB2RSTR = Reg32<base + 0x24>;
  using AHB1ENR = Reg32<base + 0x30>;
  using APB1ENR = Reg32<base + 0x40>;
  using APB2ENR = Reg32<base + 0x44>;
  using CSR = Reg32<base + 0x74>;
  static constexpr std::uint32_t HSEON = bit(16), HSERDY = bit(17), PLLON = bit(24),
                                 PLLRDY = bit(25);
  static constexpr std::uint32_t PLLSRC_HSE = bit(22);
  static constexpr std::uint32_t SW_PLL = 2u, SWS_Msk = 3u << 2, SWS_PLL = 2u << 2;
  static constexpr std::uint32_t PPRE1_DIV4 = 5u << 10, PPRE2_DIV2 = 4u << 13;
  static constexpr std::uint32_t GPIOAEN = bit(0), GPIOBEN = bit(1), GPIOCEN = bit(2),
                                 CCMDATARAMEN = bit(20), DMA1EN = bit(21), DMA2EN = bit(22);
  static constexpr std::uint32_t TIM2EN = bit(0), TIM4EN = bit(2), TIM5EN = bit(3), TIM6EN = bit(4),
                                 TIM7EN = bit(5), SPI3EN = bit(15), USART2EN = bit(17),
                                 USART3EN = bit(18), I2C1EN = bit(21), I2C2EN = bit(22),
                                 I2C3EN = bit(23), CAN1EN = bit(25), CAN2EN = bit(26),
                                 PWREN = bit(28), DACEN = bit(29);
  static constexpr std::uint32_t TIM1EN = bit(0), USART1EN = bit(4), USART6EN = bit(5),
                                 ADC1EN = bit(8), SPI1EN = bit(12), SYSCFGEN = bit(14);
  static constexpr std::uint32_t SPI1RST = bit(12);
  static constexpr std::uint32_t RMVF = bit(24), BORRSTF = bit(25), PADRSTF = bit(26),
                                 PORRSTF = bit(27), SFTRSTF = bit(28), WDGRSTF = bit(29),
                                 WWDGRSTF = bit(30), LPWRRSTF = bit(31);
};

struct UID {  // 96 bits, each part's own
  static constexpr std::uint32_t base = 0x1FFF'7A10;
};

struct PWR {
  using CR = Reg32<0x4000'7000>;
  static constexpr std::uint32_t VOS = bit(14);  // scale 1: needed above 144 MHz
};

struct FLASH {
  static constexpr std::uint32_t base = 0x4002'3C00;
  using ACR = Reg32<base + 0x00>;
  using KEYR = Reg32<base + 0x04>;
  using SR = Reg32<base + 0x0C>;
  using CR = Reg32<base + 0x10>;
  static constexpr std::uint32_t LATENCY_5WS = 5u, PRFTEN = bit(8), ICEN = bit(9), DCEN = bit(10),
                                 DCRST = bit(12);
  static constexpr std::uint32_t KEY1 = 0x4567'0123, KEY2 = 0xCDEF'89AB;
  static constexpr std::uint32_t BSY = bit(16);
  static constexpr std::uint32_t all_errors = 0xF2;  // PGSERR, PGPERR, PGAERR, WRPERR, OPERR
  static constexpr std::uint32_t PG = bit(0), SER = bit(1), PSIZE_x32 = 2u << 8, STRT = bit(16),
                                 LOCK = bit(31);
  static constexpr std::uint32_t SNB(std::uint32_t sector) { return sector << 3; }
};

template <std::uint32_t kBase>
struct Gpio {
  using MODER = Reg32<kBase + 0x00>;
  using OTYPER = Reg32<kBase + 0x04>;
  using OSPEEDR = Reg32<kBase + 0x08>;
  using PUPDR = Reg32<kBase + 0x0C>;
  using IDR = Reg32<kBase + 0x10>;
  using BSRR = Reg32<kBase + 0x18>;
  using AFRL = Reg32<kBase + 0x20>;
  using AFRH = Reg32<kBase + 0x24>;
};
using GPIOA = Gpio<0x4002'0000>;
using GPIOB = Gpio<0x4002'0400>;
using GPIOC = Gpio<0x4002'0800>;

struct ADC1 {
  static constexpr std::uint32_t base = 0x4001'2000;
  using SR = Reg32<base + 0x00>;
  using CR2 = Reg32<base + 0x08>;
  using SMPR1 = Reg32<base + 0x0C>;  // channels 10 to 18, three bits each
  using SQR1 = Reg32<base + 0x2C>;
  using SQR3 = Reg32<base + 0x34>;
  using DR = Reg32<base + 0x4C>;
  using CCR = Reg32<base + 0x304>;  // common to the three converters
  static constexpr std::uint32_t EOC = bit(1), ADON = bit(0), SWSTART = bit(30);
  static constexpr std::uint32_t SMP_56 = 3u, ADCPRE_DIV4 = 1u << 16;
};

struct DAC {
  static constexpr std::uint32_t base = 0x4000'7400;
  using CR = Reg32<base + 0x00>;
  using DHR12R1 = Reg32<base + 0x08>;
  static constexpr std::uint32_t EN1 = bit(0);
};

struct SYSCFG {
  using EXTICR1 = Reg32<0x4001'3808>;  // lines 0..3, four bits each
  using EXTICR4 = Reg32<0x4001'3814>;  // lines 12..15
};

struct EXTI {
  static constexpr std::uint32_t base = 0x4001'3C00;
  using IMR = Reg32<base + 0x00>;
  using RTSR = Reg32<base + 0x08>;
  using PR = Reg32<base + 0x14>;
};

template <std::uint32_t base>
struct Spi {
  using CR1 = Reg32<base + 0x00>;
  using CR2 = Reg32<base + 0x04>;
  using SR = Reg32<base + 0x08>;
  using DR = Reg32<base + 0x0C>;
  static constexpr std::uint32_t CPHA = bit(0), CPOL = bit(1), MSTR = bit(2), SPE = bit(6),
                                 SSI = bit(8), SSM = bit(9);
  static constexpr std::uint32_t BR_Msk = 7u << 3, BR_DIV2 = 0u << 3, BR_DIV8 = 2u << 3,
                                 BR_DIV128 = 6u << 3;
  static constexpr std::uint32_t RXDMAEN = bit(0), TXDMAEN = bit(1), RXNEIE = bit(6);
  static constexpr std::uint32_t BSY = bit(7);
};
using SPI1 = Spi<0x4001'3000>;
using SPI3 = Spi<0x4000'3C00>;

template <std::uint32_t base>
struct I2c {
  using CR1 = Reg32<base + 0x00>;
  using CR2 = Reg32<base + 0x04>;
  using OAR1 = Reg32<base + 0x08>;
  using OAR2 = Reg32<base + 0x0C>;
  using DR = Reg32<base + 0x10>;
  using SR1 = Reg32<base + 0x14>;
  using SR2 = Reg32<base + 0x18>;
  using CCR = Reg32<base + 0x1C>;
  using TRISE = Reg32<base + 0x20>;
  static constexpr std::uint32_t PE = bit(0), START = bit(8), STOP = bit(9), ACK = bit(10),
                                 SWRST = bit(15);
  static constexpr std::uint32_t ITERREN = bit(8), ITEVTEN = bit(9), ITBUFEN = bit(10),
                                 DMAEN = bit(11), LAST = bit(12);
  static constexpr std::uint32_t SB = bit(0), ADDR = bit(1), BTF = bit(2), STOPF = bit(4),
                                 RXNE = bit(6), TXE = bit(7), BERR = bit(8), ARLO = bit(9),
                                 AF = bit(10), OVR = bit(11);
  static constexpr std::uint32_t BUSY = bit(1), TRA = bit(2), DUALF = bit(7);
  static constexpr std::uint32_t FS = bit(15);
  static constexpr std::uint32_t ENDUAL = bit(0), OAR1_KEPT_ONE = bit(14);
};
using I2C1 = I2c<0x4000'5400>;
using I2C2 = I2c<0x4000'5800>;
using I2C3 = I2c<0x4000'5C00>;

template <std::uint32_t base>
struct Usart {
  using SR = Reg32<base + 0x00>;
  using DR = Reg32<base + 0x04>;
  using BRR = Reg32<base + 0x08>;
  using CR1 = Reg32<base + 0x0C>;
  using CR2 = Reg32<base + 0x10>;
  using CR3 = Reg32<base + 0x14>;
  static constexpr std::uint32_t PE = bit(0), FE = bit(1), NF = bit(2), ORE = bit(3);  // of SR
  static constexpr std::uint32_t RE = bit(2), TE = bit(3), RXNEIE = bit(5), PCE = bit(10),
                                 M = bit(12), UE = bit(13);
  static constexpr std::uint32_t STOP_2 = 2u << 12;  // of CR2
  static constexpr std::uint32_t DMAR = bit(6), DMAT = bit(7);
};
using USART1 = Usart<0x4001'1000>;
using USART2 = Usart<0x4000'4400>;
using USART3 = Usart<0x4000'4800>;
using USART6 = Usart<0x4001'1400>;

// bxCAN; its registers: hal/bxcan_registers.hpp. The filters of both are CAN1's.
using CAN1 = RegBlock<0x4000'6400>;
using CAN2 = RegBlock<0x4000'6800>;

template <std::uint32_t kBase>
struct Timer {
  using CR1 = Reg32<kBase + 0x00>;
  using DIER = Reg32<kBase + 0x0C>;
  using SR = Reg32<kBase + 0x10>;
  using EGR = Reg32<kBase + 0x14>;
  using CNT = Reg32<kBase + 0x24>;
  using PSC = Reg32<kBase + 0x28>;
  using ARR = Reg32<kBase + 0x2C>;
  static constexpr std::uint32_t CEN = bit(0), URS = bit(2), OPM = bit(3), UIE = bit(0),
                                 UIF = bit(0), UG = bit(0);
};
struct TIM1 : Timer<0x4001'0000> {  // 16 bits
  using CCMR2 = Reg32<0x4001'0000 + 0x1C>;
  using CCER = Reg32<0x4001'0000 + 0x20>;
  using CCR3 = Reg32<0x4001'0000 + 0x3C>;
  static constexpr std::uint32_t CKD_DIV4 = 2u << 8, CC3IE = bit(3), CC3IF = bit(3),
                                 CC3OF = bit(11), CC3S_TI3 = 1u, IC3F_LONGEST = 15u << 4,
                                 CC3E = bit(8);
};
using TIM2 = Timer<0x4000'0000>;    // 32 bits
struct TIM4 : Timer<0x4000'0800> {  // 16 bits
  using CCMR1 = Reg32<0x4000'0800 + 0x18>;
  using CCER = Reg32<0x4000'0800 + 0x20>;
  using CCR1 = Reg32<0x4000'0800 + 0x34>;
  static constexpr std::uint32_t ARPE = bit(7), OC1M_PWM1 = 6u << 4, OC1PE = bit(3), CC1E = bit(0);
};
using TIM5 = Timer<0x4000'0C00>;  // 32 bits
using TIM6 = Timer<0x4000'1000>;  // 16 bits
using TIM7 = Timer<0x4000'1400>;  // 16 bits

template <std::uint32_t kBase, unsigned kStream>
struct DmaStream {
  using CR = Reg32<kBase + 0x10 + 0x18 * kStream>;
  using NDTR = Reg32<kBase + 0x14 + 0x18 * kStream>;
  using PAR = Reg32<kBase + 0x18 + 0x18 * kStream>;
  using M0AR = Reg32<kBase + 0x1C + 0x18 * kStream>;
  using FCR = Reg32<kBase + 0x24 + 0x18 * kStream>;
  using ISR = Reg32<kBase + (kStream < 4 ? 0x00 : 0x04)>;
  using IFCR = Reg32<kBase + (kStream < 4 ? 0x08 : 0x0C)>;
  static constexpr unsigned flag_shift = std::array<unsigned, 4>{0, 6, 16, 22}[kStream % 4];
  static constexpr std::uint32_t TCIF = bit(5) << flag_shift, TEIF = bit(3) << flag_shift,
                                 all_flags = 0x3Du << flag_shift;
  static constexpr std::uint32_t EN = bit(0), TEIE = bit(2), TCIE = bit(4), DIR_M2P = 1u << 6,
                                 CIRC = bit(8), MINC = bit(10);
  static constexpr std::uint32_t priority(std::uint32_t level) { return level << 16; }
  static constexpr std::uint32_t channel(std::uint32_t n) { return n << 25; }
};
inline constexpr std::uint32_t kDma1 = 0x4002'6000, kDma2 = 0x4002'6400;
using Spi3RxDma = DmaStream<kDma1, 0>;    // channel 0
using Spi3TxDma = DmaStream<kDma1, 7>;    // channel 0
using I2c3RxDma = DmaStream<kDma1, 2>;    // channel 3
using I2c2RxDma = DmaStream<kDma1, 3>;    // channel 7
using Usart3RxDma = DmaStream<kDma1, 1>;  // channel 4
using Usart3TxDma = DmaStream<kDma1, 3>;  // channel 4
using Usart2RxDma = DmaStream<kDma1, 5>;  // channel 4
using Usart2TxDma = DmaStream<kDma1, 6>;  // channel 4
using Spi1RxDma = DmaStream<kDma2, 0>;    // channel 3
using Usart6RxDma = DmaStream<kDma2, 2>;  // channel 5
using Spi1TxDma = DmaStream<kDma2, 3>;    // channel 3
using Usart6TxDma = DmaStream<kDma2, 6>;  // channel 5
using Usart1RxDma = DmaStream<kDma2, 5>;  // channel 4
using Usart1TxDma = DmaStream<kDma2, 7>;  // channel 4

// Interrupt numbers, RM0090 table 61.
enum class Irq : std::uint8_t {
  EXTI3 = 9,
  DMA1_Stream2 = 13,
  DMA1_Stream3 = 14,
  DMA1_Stream6 = 17,
  TIM1_CC = 27,
  TIM4_Global = 30,
  I2C1_EV = 31,
  I2C1_ER = 32,
  I2C2_EV = 33,
  I2C2_ER = 34,
  SPI1_Global = 35,
  USART1_Global = 37,
  EXTI15_10 = 40,
  TIM5_Global = 50,
  TIM6_DAC = 54,
  TIM7_Global = 55,
  DMA2_Stream0 = 56,
  CAN2_TX = 63,
  CAN2_RX0 = 64,
  CAN2_SCE = 66,
  DMA2_Stream6 = 69,
  DMA2_Stream7 = 70,
  I2C3_EV = 72,
  I2C3_ER = 73,
};
inline constexpr unsigned kIrqCount = 82;

template <Irq kIrq>
using Nvic = NvicLine<static_cast<unsigned>(kIrq)>;

}  // namespace fw::hw

// Bits of the ADC registers; CR1 and the sequence registers are the same in both families.
#pragma once
#include <cstdint>

namespace whirl::stm32::adc {

enum Offset : std::uint32_t {
  SR = 0x00,
  CR1 = 0x04,
  CR2 = 0x08,
  SMPR1 = 0x0C,
  SMPR2 = 0x10,
  JOFR1 = 0x14,
  JOFR4 = 0x20,
  HTR = 0x24,
  LTR = 0x28,
  SQR1 = 0x2C,
  SQR2 = 0x30,
  SQR3 = 0x34,
  JSQR = 0x38,
  JDR1 = 0x3C,
  JDR4 = 0x48,
  DR = 0x4C,
  CSR = 0x00,
  CCR = 0x04,
  CDR = 0x08,
};
inline constexpr std::uint32_t AWD = 1, EOC = 2, JEOC = 4, JSTRT = 8, STRT = 16, OVR = 32;
// CR1
inline constexpr std::uint32_t EOCIE = 1u << 5, AWDIE = 1u << 6, JEOCIE = 1u << 7, SCAN = 1u << 8,
                               AWDSGL = 1u << 9, JAUTO = 1u << 10, DISCEN = 1u << 11,
                               JDISCEN = 1u << 12, JAWDEN = 1u << 22, AWDEN = 1u << 23,
                               OVRIE = 1u << 26;
// CR2, both
inline constexpr std::uint32_t ADON = 1, CONT = 2, DMA = 1u << 8, ALIGN = 1u << 11;
// CR2, F405
inline constexpr std::uint32_t DDS = 1u << 9, EOCS = 1u << 10, JSWSTART_F4 = 1u << 22,
                               SWSTART_F4 = 1u << 30;
// CR2, F103
inline constexpr std::uint32_t CAL = 4, RSTCAL = 8, JEXTTRIG = 1u << 15, EXTTRIG = 1u << 20,
                               JSWSTART_F1 = 1u << 21, SWSTART_F1 = 1u << 22, TSVREFE_F1 = 1u << 23;
// CCR, F405
inline constexpr std::uint32_t CCR_DDS = 1u << 13, VBATE = 1u << 22, TSVREFE = 1u << 23;

}  // namespace whirl::stm32::adc

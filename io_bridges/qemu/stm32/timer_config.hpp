// What each timer of the family can do, and the bits of its registers (RM0090 ch. 17-20, RM0008 14-17).
#pragma once
#include <cstdint>

namespace whirl::stm32 {

enum class TimerKind : std::uint8_t {
  advanced,     // TIM1, TIM8
  general_32,   // TIM2, TIM5 of F405
  general_16,   // TIM3, TIM4; TIM2 of F103
  two_channel,  // TIM9, TIM12
  one_channel,  // TIM10, 11, 13, 14
  basic,        // TIM6, TIM7
};

struct TimerAbilities {
  int channels;
  bool wide;      // 32-bit CNT, ARR, CCRx
  bool advanced;  // RCR, BDTR, complementary outputs
  bool down;      // DIR, CMS
  bool slave;     // SMCR, and the trigger flag
  bool master;    // CR2.MMS
  bool external;  // ETR
  bool dma;
  bool option;  // OR
};

constexpr TimerAbilities abilities(TimerKind kind) {
  switch (kind) {
    case TimerKind::advanced:
      return {4, false, true, true, true, true, true, true, false};
    case TimerKind::general_32:
      return {4, true, false, true, true, true, true, true, true};
    case TimerKind::general_16:
      return {4, false, false, true, true, true, true, true, false};
    case TimerKind::two_channel:
      return {2, false, false, false, true, false, false, false, false};
    case TimerKind::one_channel:
      return {1, false, false, false, false, false, false, false, true};
    case TimerKind::basic:
      return {0, false, false, false, false, true, false, true, false};
  }
  return {};
}

struct TimerConfig {
  int number = 0;
  TimerKind kind = TimerKind::general_16;
  bool on_apb2 = false;    // counts timclk2, else timclk1
  bool both_edges = true;  // CCxP with CCxNP captures both edges (F405; F103 has no CCxNP there)
  int update_irq = -1;     // general timers: the only one
  int compare_irq = -1;    // advanced timers have four
  int trigger_irq = -1;
  int break_irq = -1;
};

namespace tim {
enum Offset : std::uint32_t {
  CR1 = 0x00,
  CR2 = 0x04,
  SMCR = 0x08,
  DIER = 0x0C,
  SR = 0x10,
  EGR = 0x14,
  CCMR1 = 0x18,
  CCMR2 = 0x1C,
  CCER = 0x20,
  CNT = 0x24,
  PSC = 0x28,
  ARR = 0x2C,
  RCR = 0x30,
  CCR1 = 0x34,
  CCR2 = 0x38,
  CCR3 = 0x3C,
  CCR4 = 0x40,
  BDTR = 0x44,
  DCR = 0x48,
  DMAR = 0x4C,
  OR = 0x50,
};
// CR1
inline constexpr std::uint32_t CEN = 1, UDIS = 2, URS = 4, OPM = 8, DIR = 16, ARPE = 128;
// CR2
inline constexpr std::uint32_t CCPC = 1, CCUS = 4, CCDS = 8, TI1S = 128;
// SMCR
inline constexpr std::uint32_t ECE = 1u << 14, ETP = 1u << 15;
// SR, and EGR and the low half of DIER in the same places; DIER's DMA enables are 8 further up
inline constexpr std::uint32_t UIF = 1, CC1IF = 2, COMIF = 32, TIF = 64, BIF = 128, CC1OF = 512;
inline constexpr std::uint32_t UDE = 256, CC1DE = 512, COMDE = 1u << 13, TDE = 1u << 14;
// BDTR
inline constexpr std::uint32_t OSSI = 1u << 10, OSSR = 1u << 11, BKE = 1u << 12, BKP = 1u << 13,
                               AOE = 1u << 14, MOE = 1u << 15;
}  // namespace tim

}  // namespace whirl::stm32

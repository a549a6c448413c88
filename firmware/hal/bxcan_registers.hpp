// bxCAN's registers by their offset, the same on STM32F405 and STM32F103.
//
//   Names   of the reference manual
//   Source  RM0090 sec. 32.9, RM0008 sec. 24.9
#pragma once
#include <cstdint>

namespace fw::hw::bxcan {

enum Offset : std::uint32_t {
  MCR = 0x00,
  MSR = 0x04,
  TSR = 0x08,
  RF0R = 0x0C,
  IER = 0x14,
  ESR = 0x18,
  BTR = 0x1C,
  TI0R = 0x180,  // then TDTxR, TDLxR, TDHxR; the next mailbox 0x10 further
  RI0R = 0x1B0,  // then RDTxR, RDLxR, RDHxR
  FMR = 0x200,   // of CAN1 alone, from here on
  FM1R = 0x204,
  FS1R = 0x20C,
  FFA1R = 0x214,
  FA1R = 0x21C,
  F0R1 = 0x240,  // two words for each bank
};

inline constexpr std::uint32_t INRQ = 1u << 0, SLEEP = 1u << 1, TXFP = 1u << 2, ABOM = 1u << 6;
inline constexpr std::uint32_t INAK = 1u << 0, ERRI = 1u << 2;
// Of mailbox 0; those of the others are 8 bits further up each.
inline constexpr std::uint32_t RQCP0 = 1u << 0, TXOK0 = 1u << 1, ABRQ0 = 1u << 7;
inline constexpr std::uint32_t TME0 = 1u << 26;  // of the others, the next bits
inline constexpr std::uint32_t FMP0_Msk = 3, FOVR0 = 1u << 4, RFOM0 = 1u << 5;
inline constexpr std::uint32_t TMEIE = 1u << 0, FMPIE0 = 1u << 1, FOVIE0 = 1u << 3, EPVIE = 1u << 9,
                               BOFIE = 1u << 10, ERRIE = 1u << 15;
inline constexpr std::uint32_t EPVF = 1u << 1, BOFF = 1u << 2;
inline constexpr std::uint32_t TXRQ = 1u << 0, RTR = 1u << 1, IDE = 1u << 2;
inline constexpr std::uint32_t FINIT = 1u << 0;

// A bit is 1 + TS1 + TS2 quanta of `prescaler` clocks; it is sampled at the end of TS1.
constexpr std::uint32_t bit_timing(std::uint32_t prescaler, std::uint32_t ts1, std::uint32_t ts2) {
  return (prescaler - 1) | (ts1 - 1) << 16 | (ts2 - 1) << 20;
}

}  // namespace fw::hw::bxcan

// Bits of bxCAN's registers, by the names of RM0090 sec. 32.9.
#pragma once
#include <cstdint>

namespace whirl::stm32::bxcan {

// MCR
inline constexpr std::uint32_t INRQ = 1, SLEEP = 2, TXFP = 4, RFLM = 8, NART = 16, AWUM = 32,
                               ABOM = 64, RESET = 1u << 15;
// MSR
inline constexpr std::uint32_t INAK = 1, SLAK = 2, ERRI = 4, WKUI = 8, SLAKI = 16;
// Mailbox 0's part of TSR; the others 8 bits further up each
inline constexpr std::uint32_t RQCP = 1, TXOK = 2, ALST = 4, TERR = 8, ABRQ = 128;
inline constexpr std::uint32_t TXRQ = 1;
// RFxR
inline constexpr std::uint32_t FULL = 8, FOVR = 16, RFOM = 32;
// IER
inline constexpr std::uint32_t TMEIE = 1, FMPIE0 = 2, FFIE0 = 4, FOVIE0 = 8, FMPIE1 = 16,
                               FFIE1 = 32, FOVIE1 = 64, EWGIE = 1u << 8, EPVIE = 1u << 9,
                               BOFIE = 1u << 10, LECIE = 1u << 11, ERRIE = 1u << 15,
                               WKUIE = 1u << 16, SLKIE = 1u << 17;
inline constexpr std::uint32_t LBKM = 1u << 30, SILM = 1u << 31;
inline constexpr std::uint32_t EWGF = 1, EPVF = 2, BOFF = 4;
inline constexpr int kAfterInit = 1, kAfterBusOff = 128;  // runs of eleven recessive bits

}  // namespace whirl::stm32::bxcan

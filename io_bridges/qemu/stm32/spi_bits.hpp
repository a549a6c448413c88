// Registers and bits of the SPI, RM0090 28.5.
#pragma once
#include <cstdint>

namespace whirl::stm32::spi_bits {

enum Offset : std::uint32_t {
  CR1 = 0x00,
  CR2 = 0x04,
  SR = 0x08,
  DR = 0x0C,
  CRCPR = 0x10,
  RXCRCR = 0x14,
  TXCRCR = 0x18,
  I2SCFGR = 0x1C,
  I2SPR = 0x20,
};
// CR1
inline constexpr std::uint32_t CPHA = 1u << 0, CPOL = 1u << 1, MSTR = 1u << 2, SPE = 1u << 6,
                               LSBFIRST = 1u << 7, SSI = 1u << 8, SSM = 1u << 9, RXONLY = 1u << 10,
                               DFF = 1u << 11, CRCNEXT = 1u << 12, CRCEN = 1u << 13,
                               BIDIOE = 1u << 14, BIDIMODE = 1u << 15;
// CR2
inline constexpr std::uint32_t RXDMAEN = 1u << 0, TXDMAEN = 1u << 1, SSOE = 1u << 2,
                               ERRIE = 1u << 5, RXNEIE = 1u << 6, TXEIE = 1u << 7;
// SR
inline constexpr std::uint32_t RXNE = 1u << 0, TXE = 1u << 1, CRCERR = 1u << 4, MODF = 1u << 5,
                               OVR = 1u << 6, BSY = 1u << 7;

}  // namespace whirl::stm32::spi_bits

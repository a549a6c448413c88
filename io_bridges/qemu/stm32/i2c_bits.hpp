// Register bits of I2C v1, RM0090 27.6; shared by the files of the model.
#pragma once
#include <cstdint>

namespace whirl::stm32::i2c_bits {

enum Offset : std::uint32_t {
  CR1 = 0x00,
  CR2 = 0x04,
  OAR1 = 0x08,
  OAR2 = 0x0C,
  DR = 0x10,
  SR1 = 0x14,
  SR2 = 0x18,
  CCR = 0x1C,
  TRISE = 0x20,
};
inline constexpr std::uint32_t PE = 1u << 0, ENGC = 1u << 6, NOSTRETCH = 1u << 7, START = 1u << 8,
                               STOP = 1u << 9, ACK = 1u << 10, POS = 1u << 11, PEC = 1u << 12,
                               SWRST = 1u << 15,  // CR1
    ITERREN = 1u << 8, ITEVTEN = 1u << 9, ITBUFEN = 1u << 10, DMAEN = 1u << 11,
                               LAST = 1u << 12,  // CR2
    ENDUAL = 1u << 0,                            // OAR2
    SB = 1u << 0, ADDR = 1u << 1, BTF = 1u << 2, ADD10 = 1u << 3, STOPF = 1u << 4, RXNE = 1u << 6,
                               TXE = 1u << 7, BERR = 1u << 8, ARLO = 1u << 9, AF = 1u << 10,
                               OVR = 1u << 11, PECERR = 1u << 12, TIMEOUT = 1u << 14,
                               SMBALERT = 1u << 15,  // SR1
    MSL = 1u << 0, BUSY = 1u << 1, TRA = 1u << 2, GENCALL = 1u << 4,
                               DUALF = 1u << 7,  // SR2
    DUTY = 1u << 14, FS = 1u << 15;              // CCR
inline constexpr std::uint32_t kErrors = BERR | ARLO | AF | OVR | PECERR | TIMEOUT | SMBALERT;

}  // namespace whirl::stm32::i2c_bits

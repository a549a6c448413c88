#include "io_bridges/protocols/crc.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace whirl::io {
namespace {

// The catalogue of CRC algorithms prints "check": the CRC of the nine characters "123456789".
constexpr std::uint8_t kNineDigits[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};

TEST(Crc, GivesTheCatalogueCheckValues) {
  EXPECT_EQ(crc8(kNineDigits), 0xF4);  // CRC-8/SMBUS
  EXPECT_EQ(crc7(kNineDigits), 0x75);  // CRC-7/MMC
  EXPECT_EQ(crc16_xmodem(kNineDigits), 0x31C3);
  EXPECT_EQ(crc16(kNineDigits), 0x6F91);  // CRC-16/MCRF4XX
}

}  // namespace
}  // namespace whirl::io

// Golden registers of cards, each with the CRC-16 of its data block: computed outside this program
// from the tables of the specification.
#include "io_bridges/devices/sd_registers.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "io_bridges/protocols/crc.hpp"

namespace whirl::io::sd {
namespace {

std::string hex_of(const Register& bytes) {
  std::string text;
  char two[3];
  for (const std::uint8_t byte : bytes) {
    std::snprintf(two, sizeof two, "%02X", byte);
    text += two;
  }
  return text;
}

TEST(SdRegisters, CsdOfHighCapacityCards) {
  struct {
    std::int64_t KiB;
    const char* csd;
    int crc;
  } const cards[] = {{32 * 1024, "400E00325B590000003F7F800A4000A9", 0x73FA},
                     {64 * 1024, "400E00325B590000007F7F800A400051", 0xC001},
                     {7761920, "400E00325B5900003B377F800A400067", 0x48A6}};
  for (const auto& card : cards) {
    const Register got = csd(true, card.KiB * 1024);
    EXPECT_EQ(hex_of(got), card.csd);
    EXPECT_EQ(crc16_xmodem(got), card.crc);
  }
}

TEST(SdRegisters, CsdOfAStandardCardGivesItsCapacityByTheFormulaOfVersionOne) {
  const std::int64_t size_bytes = 128LL * 1024 * 1024;
  const Register r = csd(false, size_bytes);
  EXPECT_EQ(r[0] >> 6, 0);
  const int read_bl_len = r[5] & 0x0F;
  const int c_size = (r[6] & 0x03) << 10 | r[7] << 2 | r[8] >> 6;
  const int c_size_mult = (r[9] & 0x03) << 1 | r[10] >> 7;
  EXPECT_EQ((c_size + 1LL) << (c_size_mult + 2 + read_bl_len), size_bytes);
}

TEST(SdRegisters, CidOfAnEightGigabyteCard) {
  const Register got = cid({.manufacturer = 0x03,
                            .application = {'S', 'D'},
                            .product = {'S', 'U', '0', '8', 'G'},
                            .revision_bcd = 0x80,
                            .serial = 0x12345678,
                            .year = 2012,
                            .month = 6});
  EXPECT_EQ(hex_of(got), "0353445355303847801234567800C639");
  EXPECT_EQ(crc16_xmodem(got), 0xAFD9);
}

}  // namespace
}  // namespace whirl::io::sd

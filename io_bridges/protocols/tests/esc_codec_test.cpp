#include "io_bridges/protocols/esc_codec.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "base/near.hpp"

namespace whirl::io {
namespace {

constexpr EscMode kModes[] = {EscMode::duty,  EscMode::rpm,   EscMode::thrust_by_rpm,
                              EscMode::servo, EscMode::power, EscMode::thrust_by_power};

// Long division by x^8 + x^2 + x + 1, bit by bit over the whole message: another route to the CRC.
std::uint8_t remainder_of(const std::vector<std::uint8_t>& message) {
  unsigned rest = 0;
  for (std::size_t i = 0; i < message.size() * 8 + 8; ++i) {
    const bool in = i / 8 < message.size() && ((message[i / 8] >> (7 - i % 8)) & 1) != 0;
    rest = rest << 1 | (in ? 1u : 0u);
    if ((rest & 0x100) != 0) rest ^= 0x107;
  }
  return static_cast<std::uint8_t>(rest);
}

TEST(EscSetpoint, ElevenBitsTravelAsHighEightAndLowThree) {
  const auto bytes = pack_setpoint(0x29, 0x5A5);  // 101'1010'0101
  EXPECT_EQ(bytes[0], 0xB4);
  EXPECT_EQ(bytes[1], 0x05);
  EXPECT_EQ(bytes[2], remainder_of({0x52, 0xB4, 0x05}));  // 0x29 << 1 = 0x52
}

TEST(EscSetpoint, EveryValueSurvivesTheWire) {
  for (std::uint16_t v = 0; v <= kEscMaxSetpoint; ++v) {
    EXPECT_EQ(unpack_setpoint(0x2C, pack_setpoint(0x2C, v)), v);
  }
}

TEST(EscSetpoint, AnySingleFlippedBitIsRefused) {
  const auto good = pack_setpoint(0x2A, 1234);
  for (std::size_t bit = 0; bit < 24; ++bit) {
    auto bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ 1u << bit % 8);
    EXPECT_FALSE(unpack_setpoint(0x2A, bad)) << bit;
  }
}

TEST(EscSetpoint, OtherLengthsUpperBitsAndForeignAddressesAreRefused) {
  const auto good = pack_setpoint(0x29, 100);
  EXPECT_FALSE(unpack_setpoint(0x29, std::span(good).first(2)));
  EXPECT_FALSE(unpack_setpoint(0x2A, good));
  const std::uint8_t upper[] = {0x10, 0x08, remainder_of({0x52, 0x10, 0x08})};
  EXPECT_FALSE(unpack_setpoint(0x29, upper));  // right CRC, but bit 3 of lo is set
}

TEST(EscScaling, EndsOfTheRangeAreTheEndsOfTable33) {
  const double table[][2] = {{5, 100}, {1000, 6000}, {0.8, 8}, {0, 360}, {2.6, 60}, {0.6, 8}};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(value_of_setpoint(kModes[i], 1), table[i][0]);
    EXPECT_TRUE(near(value_of_setpoint(kModes[i], 2047), table[i][1], round_off(2, 360)));
  }
}

TEST(EscScaling, NearestSetpointIsWithinHalfAStep) {
  for (const EscMode mode : kModes) {
    const EscRange range = range_of(mode);
    const double step = (range.max - range.min) / 2046;
    for (int i = 0; i <= 100; ++i) {
      const double value = range.min + i / 100.0 * (range.max - range.min);
      EXPECT_TRUE(near(value_of_setpoint(mode, setpoint_of_value(mode, value)), value,
                       stated(0.5001 * step, "half a step")));
    }
  }
  EXPECT_EQ(setpoint_of_value(EscMode::thrust_by_rpm, -1.0), 1);
  EXPECT_EQ(setpoint_of_value(EscMode::thrust_by_rpm, 99.0), 2047);
}

TEST(EscStatus, CurrentIsSignedMilliampsAndSpeedIsRpmLittleEndian) {
  const auto bytes = pack_status(0x29, {-0.002, 4000.0, 0x03});
  const std::vector<std::uint8_t> body{0xFE, 0xFF, 0xA0, 0x0F, 0x03};
  EXPECT_EQ(std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + 5), body);
  EXPECT_EQ(bytes[5], remainder_of({0x53, 0xFE, 0xFF, 0xA0, 0x0F, 0x03}));
  const auto back = unpack_status(0x29, bytes);
  ASSERT_TRUE(back);
  EXPECT_TRUE(near(back->bus_current_A, -0.002, round_off(1, 1)));
  EXPECT_EQ(back->speed_rpm, 4000.0);
}

TEST(EscStatus, StopsAtTheRailsOfItsWords) {
  const auto back = unpack_status(0x29, pack_status(0x29, {99.0, 1e6, 0}));
  ASSERT_TRUE(back);
  EXPECT_TRUE(near(back->bus_current_A, 32.767, round_off(1, 32)));
  EXPECT_EQ(back->speed_rpm, 65535.0);
}

}  // namespace
}  // namespace whirl::io

// The ESC's bytes, read twice: by the firmware's header and by the stand's codec, which share no
// line. Frames are written out: their CRCs come from a long division by x^8 + x^2 + x + 1 done
// elsewhere, whose CRC over "123456789" is the catalogue's F4 (CRC-8/SMBUS).
#include "firmware/esc/core/protocol.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "io_bridges/protocols/esc_codec.hpp"

namespace fw::esc {
namespace {

namespace stand = whirl::io;

struct Setpoint {
  unsigned motor;
  std::uint16_t v;
  protocol::SetpointBytes bytes;
};
constexpr Setpoint kSetpoints[] = {
    {1, 0, {0x00, 0x00, 0xF2}},    {1, 1, {0x00, 0x01, 0xF5}},    {2, 685, {0x55, 0x05, 0xD9}},
    {3, 1024, {0x80, 0x00, 0xEF}}, {4, 2047, {0xFF, 0x07, 0xB7}},
};

struct Answer {
  unsigned motor;
  protocol::Status status;
  protocol::StatusBytes bytes;
};
constexpr Answer kAnswers[] = {
    {1, {0, 0, 0x00}, {0x00, 0x00, 0x00, 0x00, 0x00, 0x93}},
    {1, {-2, 4000, 0x03}, {0xFE, 0xFF, 0xA0, 0x0F, 0x03, 0x9B}},
    {2, {1320, 3950, 0x43}, {0x28, 0x05, 0x6E, 0x0F, 0x43, 0xB2}},
    {3, {-32768, 65535, 0xFF}, {0x00, 0x80, 0xFF, 0xFF, 0xFF, 0x09}},
    {4, {20000, 1, 0x88}, {0x20, 0x4E, 0x01, 0x00, 0x88, 0x6F}},
};

TEST(EscProtocol, ChecksumGivesTheCatalogueValue) {
  constexpr std::uint8_t kNineDigits[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(protocol::crc8(0, kNineDigits), 0xF4);
}

TEST(EscProtocol, SetpointsAreTheseBytesForBothReaders) {
  for (const Setpoint& s : kSetpoints) {
    const std::uint8_t address = protocol::address_of(s.motor);
    EXPECT_EQ(address, stand::esc_address(static_cast<int>(s.motor)));
    EXPECT_EQ(protocol::encode_setpoint(address, s.v), s.bytes);
    EXPECT_EQ(stand::pack_setpoint(address, s.v), s.bytes);
    std::uint16_t v = 0x5555;
    EXPECT_TRUE(protocol::decode_setpoint(address, s.bytes, v));
    EXPECT_EQ(v, s.v);
    EXPECT_EQ(stand::unpack_setpoint(address, s.bytes), s.v);
  }
}

TEST(EscProtocol, StatusIsTheseBytesForBothReaders) {
  for (const Answer& a : kAnswers) {
    const std::uint8_t address = protocol::address_of(a.motor);
    EXPECT_EQ(protocol::encode_status(address, a.status), a.bytes);
    EXPECT_EQ(
        stand::pack_status(address, {a.status.current_mA / 1000.0,
                                     static_cast<double>(a.status.speed_rpm), a.status.flags}),
        a.bytes);
    protocol::Status told;
    EXPECT_TRUE(protocol::decode_status(address, a.bytes, told));
    EXPECT_EQ(told.current_mA, a.status.current_mA);
    EXPECT_EQ(told.speed_rpm, a.status.speed_rpm);
    EXPECT_EQ(told.flags, a.status.flags);
    EXPECT_TRUE(stand::unpack_status(address, a.bytes));
  }
}

TEST(EscProtocol, BothReadersRefuseTheSame) {
  struct Case {
    const char* what;
    std::vector<std::uint8_t> bytes;
  };
  const Case cases[] = {{"too short", {0x00, 0x01}},
                        {"too long", {0x00, 0x01, 0xF5, 0x00}},
                        {"another's CRC", {0x55, 0x05, 0xD9}},  // motor 2's
                        {"upper bits", {0x00, 0x08, 0xCA}},     // the CRC is right
                        {"nothing", {}}};
  for (const Case& c : cases) {
    std::uint16_t v = 0x5555;
    EXPECT_FALSE(protocol::decode_setpoint(0x29, c.bytes, v)) << c.what;
    EXPECT_EQ(v, 0x5555) << c.what;
    EXPECT_FALSE(stand::unpack_setpoint(0x29, c.bytes)) << c.what;
  }
  EXPECT_EQ(protocol::crc_of(0x29, false, std::vector<std::uint8_t>{0x00, 0x08}), 0xCA);
  // Every single flipped bit of a status.
  for (std::size_t bit = 0; bit < 48; ++bit) {
    protocol::StatusBytes bad = kAnswers[1].bytes;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ 1u << bit % 8);
    protocol::Status told;
    EXPECT_FALSE(protocol::decode_status(0x29, bad, told)) << bit;
    EXPECT_FALSE(stand::unpack_status(0x29, bad)) << bit;
  }
}

TEST(EscProtocol, FlagsHaveTheSameBits) {
  const std::uint8_t ours[] = {flag_armed,        flag_turning,       flag_saturated,
                               flag_over_current, flag_under_voltage, flag_desync,
                               flag_uncalibrated, flag_write_rejected};
  using F = stand::EscFlag;
  const std::uint8_t theirs[] = {F::kArmed,        F::kTurning,      F::kSaturated,
                                 F::kOverCurrent,  F::kUnderVoltage, F::kDesync,
                                 F::kUncalibrated, F::kWriteRejected};
  for (unsigned bit = 0; bit < 8; ++bit) {  // armed is bit 0, write rejected bit 7
    EXPECT_EQ(ours[bit], 1u << bit);
    EXPECT_EQ(theirs[bit], 1u << bit);
  }
}

}  // namespace
}  // namespace fw::esc

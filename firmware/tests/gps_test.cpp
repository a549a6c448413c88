// The GPS driver against golden frames, and against a receiver that is scripted here byte by byte.
#include <gtest/gtest.h>

#include <vector>

#include "firmware/tests/gps_rig.hpp"

namespace fw {
namespace {

using namespace gps_rig;

const Bytes kAck_rate = {0xB5, 0x62, 0x05, 0x01, 0x02, 0x00, 0x06, 0x08, 0x16, 0x3F};

bool parses(const Bytes& bytes) {
  ubx::Parser parser;
  bool got = false;
  for (const std::uint8_t byte : bytes) got = parser.push(byte) || got;
  return got;
}

TEST(UbxFrame, GoldenFramesAreRead) {
  EXPECT_TRUE(parses({0xB5, 0x62, 0x0A, 0x04, 0x00, 0x00, 0x0E, 0x34}));
  EXPECT_TRUE(parses(kAck_rate));
  EXPECT_TRUE(parses({0xB5, 0x62, 0x06, 0x01, 0x03, 0x00, 0x01, 0x06, 0x01, 0x12, 0x4F}));
  EXPECT_FALSE(parses({0xB5, 0x62, 0x06, 0x01, 0x03, 0x00, 0x01, 0x06, 0x01, 0x12, 0x4E}));
  EXPECT_FALSE(parses({0xB5, 0x62, 0x06, 0x01, 0x03, 0x00, 0x01, 0x06, 0x02, 0x12, 0x4F}));
}

TEST(UbxFrame, GoldenFramesAreWritten) {
  const auto rate = ubx::frame<6>(0x06, 0x08, {0xC8, 0, 1, 0, 0, 0});
  EXPECT_EQ(Bytes(rate.begin(), rate.end()), (Bytes{0xB5, 0x62, 0x06, 0x08, 0x06, 0x00, 0xC8, 0x00,
                                                    0x01, 0x00, 0x00, 0x00, 0xDD, 0x68}));
}

TEST(UbxFrame, ItFindsAFrameBehindGarbageAndAnImpossibleLength) {
  Bytes bytes = {0xB5, 0xB5, 0x62, 0x01, 0x02, 0xFF, 0x00, '$', 'G', 'P'};
  bytes.insert(bytes.end(), kAck_rate.begin(), kAck_rate.end());
  EXPECT_TRUE(parses(bytes));
}

TEST(UbloxGps, FindsTheReceiverAtAnyRateAndSetsItUp) {
  for (const std::uint32_t baud : {4800u, 9600u, 19200u, 38400u, 57600u, 115200u}) {
    Bench bench;
    bench.receiver.baud = baud;
    bench.run_ms(9000);
    EXPECT_TRUE(bench.gps.running()) << baud;
    EXPECT_EQ(bench.receiver.baud, 57600u);
    // Whole frames by their class, id and settings: rate, model, PVT, and three messages in its place.
    const auto& told = bench.receiver.told;
    ASSERT_GE(told.size(), 8u);
    const Bytes rate(told[told.size() - 6].begin() + 2, told[told.size() - 6].begin() + 10);
    EXPECT_EQ(rate, (Bytes{0x06, 0x08, 6, 0, 200, 0, 1, 0}));
    EXPECT_EQ(told[told.size() - 4], kPvt_on);
    EXPECT_EQ(told[told.size() - 3], (Bytes{0xB5, 0x62, 6, 1, 3, 0, 1, 2, 1, 0x0E, 0x47}));
    EXPECT_EQ(told.back(), (Bytes{0xB5, 0x62, 6, 1, 3, 0, 1, 6, 1, 0x12, 0x4F}));
  }
}

TEST(UbloxGps, AnAnswerThatIsLostIsAskedForAgain) {
  Bench bench;
  bench.receiver.baud = 57600;
  bench.run_ms(150);
  bench.receiver.lose_answers = 2;
  bench.run_ms(1500);
  EXPECT_TRUE(bench.gps.running());
  EXPECT_EQ(bench.gps.searches(), 0u);
}

TEST(UbloxGps, ARefusalIsNoAcknowledge) {
  Bench bench;
  bench.receiver.refuses = true;
  bench.run_ms(6000);
  EXPECT_FALSE(bench.gps.running());
  EXPECT_GT(bench.gps.refused(), 2u);
  bench.receiver.refuses = false;
  bench.run_ms(9000);
  EXPECT_TRUE(bench.gps.running());
}

TEST(UbloxGps, ANewerReceiverTakesPvtAndIsToldNothingBehindIt) {
  Bench bench;
  bench.receiver.is_six = false;
  bench.run_ms(4000);
  ASSERT_TRUE(bench.gps.running());
  EXPECT_TRUE(bench.gps.takes_pvt());
  EXPECT_EQ(bench.receiver.told.back(), kPvt_on);
  EXPECT_EQ(bench.gps.refused(), 0u);
}

// Each by itself: u-blox 7 sends 84 bytes, 8 sends 92.
TEST(UbloxGps, AFixIsOnePvtOfEitherLength) {
  for (const std::size_t size : {84u, 92u}) {
    Bench bench;
    bench.receiver.is_six = false;
    bench.run_ms(4000);
    GpsFix fix;
    bench.push(0x02, posllh(800)), bench.push(0x12, velned(800)), bench.push(0x06, sol(800));
    EXPECT_FALSE(bench.gps.take(fix));  // saved settings of somebody else's
    const std::uint32_t before_us = bench.now_us;
    bench.push(0x07, pvt(1000, size));
    ASSERT_TRUE(bench.gps.take(fix)) << size;
    EXPECT_FALSE(bench.gps.take(fix));
    EXPECT_EQ(fix.itow_ms, 1000u);
    EXPECT_EQ(fix.longitude_e7_deg, 1491300000);
    EXPECT_EQ(fix.latitude_e7_deg, -352800000);
    EXPECT_EQ(fix.height_mm, 600000);
    EXPECT_EQ(fix.height_sea_mm, 581000);
    EXPECT_EQ(fix.level_accuracy_mm, 3000u);
    EXPECT_EQ(fix.down_accuracy_mm, 4500u);
    EXPECT_EQ(fix.v_north_mmps, 1234);
    EXPECT_EQ(fix.v_east_mmps, -456);
    EXPECT_EQ(fix.v_down_mmps, 67);
    EXPECT_EQ(fix.speed_accuracy_mmps, 123u);
    EXPECT_EQ(fix.satellites, 9);
    EXPECT_TRUE(fix.usable());
    EXPECT_EQ(fix.received_us, before_us + 174);
  }
}

// Otherwise the next solution would seem 200 ms older than it is.
TEST(UbloxGps, AFrameThatIsSpoiltDoesNotAgeTheNext) {
  Bench bench;
  bench.receiver.is_six = false;
  bench.run_ms(4000);
  Bytes spoilt = pvt(1000, 92);
  for (const std::uint8_t byte : {0xB5, 0x62, 0x01, 0x07, 92, 0x00})
    bench.gps.push(byte, bench.now_us);
  for (const std::uint8_t byte : spoilt) bench.gps.push(byte, bench.now_us);
  for (int k = 0; k < 2; ++k) bench.gps.push(0xEE, bench.now_us);  // no checksum of it
  const std::uint32_t before_us = bench.now_us += 200'000;
  bench.push(0x07, pvt(1200, 92));
  GpsFix fix;
  ASSERT_TRUE(bench.gps.take(fix));
  EXPECT_EQ(fix.received_us, before_us + 174);
}

// Plugged in while the other is gone.
TEST(UbloxGps, AnotherGenerationInItsPlaceIsSetUpAsItNeeds) {
  Bench bench;
  bench.run_ms(4000);
  ASSERT_TRUE(bench.gps.running());
  ASSERT_FALSE(bench.gps.takes_pvt());
  bench.receiver.is_six = false;
  bench.receiver.baud = 9600;
  bench.run_ms(9000);
  EXPECT_TRUE(bench.gps.takes_pvt());
  bench.receiver.is_six = true;
  bench.receiver.baud = 9600;
  bench.run_ms(9000);
  EXPECT_FALSE(bench.gps.takes_pvt());
}

TEST(UbloxGps, AFixIsTheThreeMessagesOfOneSolutionInAnyOrder) {
  Bench bench;
  bench.run_ms(4000);
  ASSERT_TRUE(bench.gps.running());
  GpsFix fix;
  const std::uint32_t before_us = bench.now_us;
  bench.push(0x02, posllh(1000));
  bench.push(0x06, sol(1000));
  EXPECT_FALSE(bench.gps.take(fix));
  bench.push(0x12, velned(1000));
  ASSERT_TRUE(bench.gps.take(fix));
  EXPECT_FALSE(bench.gps.take(fix));
  EXPECT_EQ(fix.itow_ms, 1000u);
  EXPECT_EQ(fix.latitude_e7_deg, -352800000);
  EXPECT_EQ(fix.longitude_e7_deg, 1491300000);
  EXPECT_EQ(fix.height_mm, 600000);
  EXPECT_EQ(fix.height_sea_mm, 581000);
  EXPECT_EQ(fix.level_accuracy_mm, 3000u);
  EXPECT_EQ(fix.down_accuracy_mm, 4500u);
  EXPECT_EQ(fix.v_north_mmps, 1230);
  EXPECT_EQ(fix.v_east_mmps, -450);
  EXPECT_EQ(fix.v_down_mmps, 60);
  EXPECT_EQ(fix.speed_accuracy_mmps, 120u);
  EXPECT_EQ(fix.satellites, 9);
  EXPECT_TRUE(fix.usable());
  EXPECT_EQ(fix.received_us, before_us + 174);  // the first byte
  EXPECT_EQ(fix.age_us(bench.now_us), (36u + 60 + 44 - 1) * 174);
}

TEST(UbloxGps, MessagesOfDifferentSolutionsAreNoFix) {
  Bench bench;
  bench.run_ms(4000);
  GpsFix fix;
  bench.push(0x02, posllh(1000));
  bench.push(0x06, sol(1000));
  bench.push(0x12, velned(1200));
  EXPECT_FALSE(bench.gps.take(fix));
  bench.push(0x02, posllh(1200));
  bench.push(0x06, sol(1200));
  EXPECT_TRUE(bench.gps.take(fix));
}

TEST(UbloxGps, SilenceForTwoSecondsStartsTheSearchAnew) {
  Bench bench;
  bench.run_ms(4000);
  ASSERT_TRUE(bench.gps.running());
  bench.push(0x02, posllh(1000)), bench.push(0x12, velned(1000)), bench.push(0x06, sol(1000));
  bench.run_ms(1900);
  EXPECT_TRUE(bench.gps.running());
  bench.receiver.baud = 9600;  // a brown-out: its defaults again
  bench.run_ms(200);
  EXPECT_FALSE(bench.gps.running());
  bench.run_ms(6000);
  EXPECT_EQ(bench.receiver.baud, 57600u);
}

}  // namespace
}  // namespace fw

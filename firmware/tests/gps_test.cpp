// The GPS driver against golden frames, and against a receiver that is scripted here byte by byte.
#include <gtest/gtest.h>

#include <deque>
#include <vector>

#include "firmware/drivers/ublox_gps.hpp"

namespace fw {
namespace {

using Bytes = std::vector<std::uint8_t>;

const Bytes kAck_rate = {0xB5, 0x62, 0x05, 0x01, 0x02, 0x00, 0x06, 0x08, 0x16, 0x3F};
const Bytes kPvt_on = {0xB5, 0x62, 0x06, 0x01, 0x03, 0x00, 0x01, 0x07, 0x01, 0x13, 0x51};
const Bytes kNak_msg = {0xB5, 0x62, 0x05, 0x00, 0x02, 0x00, 0x06, 0x01, 0x0E, 0x33};

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

// A receiver at some baud rate: acknowledges CFG, follows CFG-PRT, keeps what it was told.
struct FakeReceiver {
  Status send(std::span<const std::uint8_t> bytes) {
    if (uart_baud != baud || deaf) return Status::ok;
    told.emplace_back(bytes.begin(), bytes.end());
    const std::uint8_t id = bytes[3];
    if (lose_answers > 0) {
      --lose_answers;
    } else if (id == 0x01 && (refuses || (is_six && told.back() == kPvt_on))) {
      answers.insert(answers.end(), kNak_msg.begin(), kNak_msg.end());
    } else {
      Bytes ack = {0xB5, 0x62, 0x05, 0x01, 0x02, 0x00, 0x06, id};
      std::uint8_t a = 0, b = 0;
      for (std::size_t i = 2; i < ack.size(); ++i) a = a + ack[i], b = b + a;
      ack.push_back(a);
      ack.push_back(b);
      if (id != 0x00 || baud == port_baud(bytes))
        answers.insert(answers.end(), ack.begin(), ack.end());
    }
    if (id == 0x00) baud = port_baud(bytes);
    return Status::ok;
  }
  static std::uint32_t port_baud(std::span<const std::uint8_t> bytes) {
    return bytes[14] | bytes[15] << 8 | bytes[16] << 16;
  }
  void set_baud(std::uint32_t wanted) {
    uart_baud = wanted;
    bauds.push_back(wanted);
  }
  std::uint32_t baud = 9600, uart_baud = 0;
  bool deaf = false, refuses = false, is_six = true;
  int lose_answers = 0;
  std::deque<std::uint8_t> answers;
  std::vector<Bytes> told;
  std::vector<std::uint32_t> bauds;
};

struct Bench {
  FakeReceiver receiver;
  UbloxGps<FakeReceiver> gps{receiver};
  std::uint32_t now_us = 0xFFFF'0000;  // it wraps soon

  void run_ms(int ms) {
    for (int k = 0; k < ms; k += 5, now_us += 5000) {
      gps.tick(now_us);
      for (; !receiver.answers.empty(); receiver.answers.pop_front()) {
        gps.push(receiver.answers.front(), now_us);
      }
    }
  }
  void push(std::uint8_t id, Bytes payload) {
    Bytes bytes = {0xB5, 0x62, 0x01, id, static_cast<std::uint8_t>(payload.size()), 0x00};
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    std::uint8_t a = 0, b = 0;
    for (std::size_t i = 2; i < bytes.size(); ++i) a = a + bytes[i], b = b + a;
    bytes.push_back(a);
    bytes.push_back(b);
    for (const std::uint8_t byte : bytes) gps.push(byte, now_us += 174);  // 57600 baud
  }
};

void put(Bytes& payload, std::size_t at, std::int64_t value) {
  for (std::size_t i = 0; i < 4; ++i) payload[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
}
Bytes posllh(std::uint32_t itow_ms) {
  Bytes p(28);
  put(p, 0, itow_ms), put(p, 4, 1491300000), put(p, 8, -352800000), put(p, 12, 600000);
  put(p, 16, 581000), put(p, 20, 3000), put(p, 24, 4500);
  return p;
}
Bytes velned(std::uint32_t itow_ms) {
  Bytes p(36);
  put(p, 0, itow_ms), put(p, 4, 123), put(p, 8, -45), put(p, 12, 6), put(p, 28, 12);
  return p;
}
Bytes sol(std::uint32_t itow_ms) {
  Bytes p(52);
  put(p, 0, itow_ms);
  p[10] = 3, p[11] = 0x0D, p[47] = 9;
  return p;
}

Bytes pvt(std::uint32_t itow_ms, std::size_t size) {
  Bytes p(size);
  put(p, 0, itow_ms), put(p, 24, 1491300000), put(p, 28, -352800000), put(p, 32, 600000);
  put(p, 36, 581000), put(p, 40, 3000), put(p, 44, 4500);
  put(p, 48, 1234), put(p, 52, -456), put(p, 56, 67), put(p, 60, 9999), put(p, 68, 123);
  p[20] = 3, p[21] = 0x01, p[23] = 9;
  return p;
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
  bench.push(0x02, posllh(1000));
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

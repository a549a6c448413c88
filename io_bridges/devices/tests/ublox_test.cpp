// What the receiver puts out: offsets, units and scales of each field as two independent drivers' structs
// have them.
#include <cmath>

#include "base/near.hpp"
#include "io_bridges/devices/tests/ublox_bench.hpp"

namespace whirl::io {
namespace {

constexpr double kDeg = 180.0 / M_PI;

TEST(Ublox, ByDefaultItSendsNmeaAt9600BaudOnceASecond) {
  UbloxBench bench;
  bench.run(4.9);
  std::size_t lines = 0;
  for (const char* start : {"$GPGGA,", "$GPGLL,", "$GPGSA,", "$GPRMC,", "$GPVTG,"}) {
    for (auto at = bench.text.find(start); at != std::string::npos; ++lines) {
      at = bench.text.find(start, at + 1);
    }
  }
  EXPECT_EQ(lines, 5u * 4);  // at 1, 2, 3 and 4 s
  EXPECT_TRUE(bench.frames.empty());
  EXPECT_EQ(bench.bauds.front(), 9600.0);
  // 70 ms after the measurement, and the ten bits of the first character.
  EXPECT_EQ(bench.times[0], 1'070'000'000 + 1'041'667);
  EXPECT_EQ(bench.times[1] - bench.times[0], 1'041'667);
  EXPECT_TRUE(bench.findings.empty());
}

// The calendar: GPS week 1800 began on Sunday, 6 July 2014; 16 leap seconds before UTC.
TEST(Ublox, NmeaTellsPlaceTimeAndCourse) {
  UbloxBench bench;
  bench.truth.place = {47.285233167 / kDeg, -8.565265167 / kDeg, 547.6};
  bench.truth.geoid_m = 48.0;
  bench.truth.v_NED_mps = {1.0, 0.0, 0.0};
  bench.run(19.5);
  const auto rmc =
      bench.text.find("$GPRMC,000003.00,A,4717.11399,N,00833.91591,W,1.944,0.00,100714,,,A*");
  EXPECT_NE(rmc, std::string::npos) << bench.text;
  EXPECT_NE(bench.text.find("$GPGGA,000003.00,4717.11399,N,00833.91591,W,1,"), std::string::npos);
  EXPECT_NE(bench.text.find(",499.6,M,48.0,M,,*"), std::string::npos);
  EXPECT_NE(bench.text.find("$GPVTG,0.00,T,,M,1.944,N,3.600,K,A*"), std::string::npos);
}

// What every u-blox module says on a desk without an antenna.
TEST(Ublox, NmeaWithoutAFixLeavesItsFieldsEmpty) {
  UbloxBench bench(UbloxModel::six, 60.0);
  bench.run(1.9);
  EXPECT_EQ(bench.text,
            "$GPGGA,,,,,,0,00,99.99,,,,,,*48\r\n"
            "$GPGLL,,,,,,V,N*64\r\n"
            "$GPGSA,A,1,,,,,,,,,,,,,99.99,99.99,99.99*30\r\n"
            "$GPRMC,,V,,,,,,,,,,N*53\r\n"
            "$GPVTG,,,,,,,,,N*30\r\n");
}

struct NavBench : UbloxBench {
  explicit NavBench(UbloxModel model = UbloxModel::six) : UbloxBench(model, 2.0) {
    ubx_only();
    for (const std::uint8_t id : {0x02, 0x03, 0x04, 0x06, 0x12, 0x21}) switch_on(id);
    if (model == UbloxModel::m8) switch_on(0x07);
    run(1.0);
    queue.run_until(2'900'000'000);
  }
};

TEST(Ublox, PosllhInDegreesAndMillimetres) {
  NavBench bench;
  EXPECT_EQ(bench.nav<std::uint32_t>(0x02, 0), 345'602'000u);  // Thursday 0 h and 2 s
  EXPECT_EQ(bench.nav<std::int32_t>(0x02, 4), -572957795);     // -1 rad
  EXPECT_EQ(bench.nav<std::int32_t>(0x02, 8), 286478898);      // 0.5 rad
  EXPECT_EQ(bench.nav<std::int32_t>(0x02, 12), 250'000);
  EXPECT_EQ(bench.nav<std::int32_t>(0x02, 16), 210'000);
  EXPECT_EQ(bench.nav<std::uint32_t>(0x02, 20), 15'000u);  // five times 3 m at first
  EXPECT_EQ(bench.nav<std::uint32_t>(0x02, 24), 4'500u);
  EXPECT_EQ(bench.of(1, 2).back().payload.size(), 28u);
}

// 3 m/s north and 4 m/s west: 5 m/s on a course of 306.87 degrees.
TEST(Ublox, VelnedInCentimetresPerSecond) {
  NavBench bench;
  EXPECT_EQ(bench.nav<std::int32_t>(0x12, 4), 300);
  EXPECT_EQ(bench.nav<std::int32_t>(0x12, 8), -400);
  EXPECT_EQ(bench.nav<std::int32_t>(0x12, 12), 50);
  EXPECT_EQ(bench.nav<std::uint32_t>(0x12, 16), 502u);
  EXPECT_EQ(bench.nav<std::uint32_t>(0x12, 20), 500u);
  EXPECT_EQ(bench.nav<std::int32_t>(0x12, 24), 30'686'990);
  EXPECT_EQ(bench.nav<std::uint32_t>(0x12, 28), 12u);
  EXPECT_EQ(bench.of(1, 0x12).back().payload.size(), 36u);
}

TEST(Ublox, SolIsEarthCentred) {
  UbloxBench bench;
  bench.truth.place = {0.0, M_PI / 2.0, 100.0};  // y axis
  bench.truth.v_NED_mps = {1.0, 2.0, 3.0};       // z, -x, -y there
  bench.ubx_only();
  bench.switch_on(0x06);
  bench.run(3.0);
  EXPECT_EQ(bench.nav<std::int16_t>(0x06, 8), 1800);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 10), 3);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 11), 0x0D);
  EXPECT_EQ(bench.nav<std::int32_t>(0x06, 12), 0);
  EXPECT_EQ(bench.nav<std::int32_t>(0x06, 16), 637'823'700);
  EXPECT_EQ(bench.nav<std::int32_t>(0x06, 20), 0);
  EXPECT_EQ(bench.nav<std::int32_t>(0x06, 28), -200);
  EXPECT_EQ(bench.nav<std::int32_t>(0x06, 32), -300);
  EXPECT_EQ(bench.nav<std::int32_t>(0x06, 36), 100);
  EXPECT_EQ(bench.of(1, 6).back().payload.size(), 52u);
}

TEST(Ublox, StatusDopAndTime) {
  NavBench bench;
  EXPECT_EQ(bench.nav<std::uint8_t>(0x03, 4), 3);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x03, 5), 0x0D);
  EXPECT_EQ(bench.nav<std::uint32_t>(0x03, 8), 2000u);   // to the first fix
  EXPECT_EQ(bench.nav<std::uint32_t>(0x03, 12), 2000u);  // since the start
  EXPECT_EQ(bench.nav<std::uint16_t>(0x04, 12), 500);    // hDOP 5 at first
  EXPECT_EQ(bench.of(1, 4).back().payload.size(), 18u);
  EXPECT_EQ(bench.nav<std::uint16_t>(0x21, 12), 2014);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x21, 14), 7);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x21, 15), 9);  // 16 s before Thursday
  EXPECT_EQ(bench.nav<std::uint8_t>(0x21, 16), 23);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x21, 18), 46);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x21, 19), 7);
}

TEST(Ublox, PvtOfAnM8) {
  NavBench bench(UbloxModel::m8);
  EXPECT_EQ(bench.of(1, 7).back().payload.size(), 92u);
  EXPECT_EQ(bench.nav<std::uint16_t>(0x07, 4), 2014);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x07, 20), 3);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x07, 21), 1);
  EXPECT_EQ(bench.nav<std::int32_t>(0x07, 24), -572957795);
  EXPECT_EQ(bench.nav<std::int32_t>(0x07, 48), 3000);
  EXPECT_EQ(bench.nav<std::int32_t>(0x07, 60), 5000);
  EXPECT_EQ(bench.nav<std::uint32_t>(0x07, 68), 120u);
  EXPECT_EQ(bench.nav<std::uint16_t>(0x07, 76), 901);  // 5 x the root of 1 + 1.5^2
}

TEST(Ublox, BeforeTheFirstFixThereAreNoSatellitesAndAfterItTheyBecomeMore) {
  UbloxBench bench;
  bench.ubx_only();
  bench.switch_on(0x06);
  bench.queue.run_until(1'500'000'000);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 10), 0);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 11), 0);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 47), 0);
  bench.queue.run_until(2'500'000'000);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 47), 4);
  const auto early_cm = bench.nav<std::uint32_t>(0x06, 24);
  bench.queue.run_until(90'000'000'000);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 47), 9);
  EXPECT_LT(bench.nav<std::uint32_t>(0x06, 24), early_cm / 2);
}

TEST(Ublox, PollsAreAnsweredWithTheNewestSolutionAndTheVersion) {
  UbloxBench bench;
  bench.ubx_only();
  bench.run(3.0);
  bench.forget();
  bench.send(Bytes{0xB5, 0x62, 0x0A, 0x04, 0x00, 0x00, 0x0E, 0x34});
  bench.run(0.1);
  ASSERT_EQ(bench.frames.size(), 1u);
  ASSERT_EQ(bench.frames[0].payload.size(), 40u);
  const auto& p = bench.frames[0].payload;
  EXPECT_EQ(std::string(p.begin() + 30, p.begin() + 38), "00040007");
  bench.forget();
  bench.send(UbxFrame{0x01, 0x02, {}});
  bench.run(0.1);
  EXPECT_EQ(bench.of(1, 2).size(), 1u);
  EXPECT_TRUE(bench.of(5, 1).empty());
}

TEST(Ublox, MoreMessagesThanTheLineCarriesAreLostAndThatIsAFinding) {
  NavBench bench;
  bench.send(UbxFrame{0x06, 0x08, {0xC8, 0, 1, 0, 0, 0}});
  for (const std::uint8_t id : {0, 1, 2, 4, 5}) bench.send(UbxFrame{0x06, 0x01, {0xF0, id, 1}});
  bench.send(
      UbxFrame{0x06, 0x00, {1, 0, 0, 0, 0xD0, 8, 0, 0, 0x80, 0x25, 0, 0, 3, 0, 3, 0, 0, 0, 0, 0}});
  bench.run(5.0);
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_EQ(bench.findings[0], "its messages do not fit into 9600 baud: some are lost");
  const double share = static_cast<double>(bench.bytes.size()) / 960.0;
  EXPECT_LT(share, 9.0);  // the line was never faster than it is
}

}  // namespace
}  // namespace whirl::io

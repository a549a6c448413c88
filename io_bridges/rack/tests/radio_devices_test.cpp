// Receivers as a board carries them: from the keys of a board file and messages to bytes and edges.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "io_bridges/protocols/ubx.hpp"
#include "io_bridges/rack/tests/bench_rack.hpp"

namespace whirl::rack {
namespace {

BoardDevice gps(const char* type = "ublox_6") {
  BoardDevice device{.name = "gps", .type = type, .bus = "usart6"};
  for (const char* quiet :
       {"wander_level", "wander_down", "velocity_noise", "velocity_noise_down"}) {
    device.set(std::string("params.") + quiet, 0.0);
  }
  device.set("params.first_fix", 1.0);
  return device;
}

io::UbxFrame posllh_of(BenchRack& rack) {
  io::UbxFrame got;
  io::UbxParser parser([&got](const io::UbxFrame& frame) { got = frame; });
  rack.uart_bytes.clear();
  for (const std::uint8_t byte : io::encode(io::UbxFrame{0x01, 0x02, {}})) {
    rack.uart->receive({.value = byte}, {.baud = 9600.0}, rack.queue.now());
  }
  rack.run_ms(800.0);
  for (const std::uint8_t byte : rack.uart_bytes) parser.add(byte);
  EXPECT_EQ(got.payload.size(), 28u);
  return got;
}

// A degree of latitude is 110 922 m long at 35.28 degrees, one of longitude 90 964 m (WGS84, at 600 m
// of height 10 m and 9 m longer).
TEST(UbloxDevice, TheBodysPlaceIsThereOnTheEarth) {
  BenchRack rack;
  ASSERT_NE(rack.add(gps()), nullptr) << rack.error;
  io::BodyMotion motion;
  motion.p_WB_W_m[0] = 100.0;
  motion.p_WB_W_m[1] = -50.0;
  motion.p_WB_W_m[2] = -30.0;
  rack.send(motion);
  rack.run_ms(60'100.0);
  const io::UbxFrame frame = posllh_of(rack);
  const double longitude = frame.get<std::int32_t>(4) * 1e-7,
               latitude = frame.get<std::int32_t>(8) * 1e-7;
  EXPECT_TRUE(near((latitude + 35.28) * 110'932.0, 100.0, stated(0.4, "white noise, 1e-7 deg")));
  EXPECT_TRUE(near((longitude - 149.13) * 90'973.0, -50.0, stated(0.4, "white noise, 1e-7 deg")));
  EXPECT_TRUE(near(frame.get<std::int32_t>(12) * 1e-3, 630.0, stated(0.6, "white noise")));
  EXPECT_TRUE(near(frame.get<std::int32_t>(16) * 1e-3, 611.0, stated(0.6, "white noise")));
}

TEST(UbloxDevice, EachSolutionIsToldWithItsError) {
  BenchRack rack;
  ASSERT_NE(rack.add(gps()), nullptr) << rack.error;
  io::BodyMotion motion;
  motion.p_WB_W_m[0] = 100.0;
  rack.send(motion);
  rack.run_ms(3'500.0);
  int told = 0;
  for (io::Reader r(rack.posted.bytes()); r.next();) {
    if (r.header().kind != io::Kind::gnss_solution) continue;
    const auto s = r.as<io::GnssSolution>();
    EXPECT_TRUE(near(s.p_WB_W_m[0] - s.p_error_W_m[0], 100.0, round_off(4, 100.0)));
    EXPECT_NE(s.p_error_W_m[0], 0.0);
    EXPECT_EQ(r.header().t_ns % 1'000'000'000, 0);
    ++told;
  }
  EXPECT_EQ(told, 3);
}

TEST(UbloxDevice, KeysAreChecked) {
  BenchRack rack;
  BoardDevice device = gps("ublox_m8");
  device.set("params.satellites", 13.0);
  EXPECT_EQ(rack.add(device), nullptr);
  EXPECT_EQ(rack.error, "params.satellites: 13 is outside 4..12");
  device = gps();
  device.bus = "spi1";
  EXPECT_EQ(rack.add(device), nullptr);
}

TEST(UbloxDevice, AFaultFindsItByItsNumberAndNamesItsAxes) {
  BenchRack rack;
  ASSERT_NE(rack.add(gps()), nullptr) << rack.error;
  rack.book.add({.number = 1,
                 .kind = io::FaultKind::sensor_offset,
                 .bus = 6,
                 .address = 0,
                 .axis = 2,
                 .value = -50.0});
  rack.run_ms(60'100.0);
  EXPECT_TRUE(
      near(posllh_of(rack).get<std::int32_t>(12) * 1e-3, 650.0, stated(0.6, "white noise")));
  EXPECT_EQ(find_type(device_types(), "ublox_6")->senses.at(2), "down");
}

BoardDevice receiver(const char* type, const char* bus) {
  return {.name = "rc", .type = type, .bus = bus};
}

TEST(RcDevices, SticksBecomeEdgesOfThePin) {
  BenchRack rack;
  BoardDevice device = receiver("cppm", "PA10");
  device.set("params.jitter", 0.0);
  ASSERT_NE(rack.add(device), nullptr) << rack.error;
  std::vector<Nanoseconds> rises;
  rack.pin("PA10")->watch([&](bool level, Nanoseconds now) {
    if (level) rises.push_back(now);
  });
  rack.send(io::Kind::rc_channels, io::RcChannels{{1.0, -1.0}});
  rack.run_ms(60.0);
  ASSERT_GT(rises.size(), 4u);
  EXPECT_EQ(rises[1] - rises[0], 2'000'000);
  EXPECT_EQ(rises[2] - rises[1], 1'000'000);
}

TEST(RcDevices, SticksBecomeSbusAndTheInverterIsAKey) {
  BenchRack rack;
  BoardDevice device = receiver("sbus", "usart6");
  device.set("inverter", true);
  ASSERT_NE(rack.add(device), nullptr) << rack.error;
  for (int k = 0; k < 20; ++k) {
    rack.send(io::Kind::rc_channels, io::RcChannels{{-1.0}});
    rack.run_ms(20.0);
  }
  ASSERT_GT(rack.uart_bytes.size(), 50u);
  const std::size_t last = rack.uart_bytes.size() / 25 * 25 - 25;
  EXPECT_EQ(rack.uart_bytes[last], 0x0F);
  EXPECT_EQ(rack.uart_bytes[last + 1], 172);
  EXPECT_EQ(rack.uart_bytes[last + 23], 0x00);
  EXPECT_FALSE(rack.uart_format.inverted);
  EXPECT_EQ(rack.uart_format.baud, 100000.0);
}

TEST(RcDevices, AStyleOfFailsafeIsOneOfThree) {
  BenchRack rack;
  BoardDevice device = receiver("cppm", "PA10");
  device.set("params.failsafe", std::string("land"));
  EXPECT_EQ(rack.add(device), nullptr);
  EXPECT_EQ(rack.error, "params.failsafe: 'land' is not stop/hold/fixed");
}

}  // namespace
}  // namespace whirl::rack

// The magnetometer as a board carries it: from the keys of a board file and a message to counts.
#include <gtest/gtest.h>

#include "io_bridges/rack/tests/bench_rack.hpp"

namespace whirl::rack {
namespace {

using Counts = std::array<int, 3>;  // x, z, y

BoardDevice compass(const std::vector<std::string>& axes) {
  BoardDevice device{.name = "mag", .type = "hmc5883l", .bus = "i2c1", .address = 0x1E};
  device.set("axes", axes);
  device.set("params.noise", 0.0);
  return device;
}

Counts measure(BenchRack& rack) {
  rack.run_ms(60.0);
  rack.i2c_transfer(0x1E, {0x02, 0x01}, 0);
  rack.run_ms(7.0);
  const auto got = rack.i2c_transfer(0x1E, {0x03}, 6);
  const auto word = [&got](std::size_t at) {
    return static_cast<std::int16_t>(got[at] << 8 | got[at + 1]);
  };
  return {word(0), word(2), word(4)};
}

// 0.1, 0.2 and 0.3 Ga along the body's axes, at 1090 counts a gauss.
void send_field(BenchRack& rack) {
  io::BodyMotion motion;
  motion.magnetic_field_B_T[0] = 1e-5;
  motion.magnetic_field_B_T[1] = 2e-5;
  motion.magnetic_field_B_T[2] = 3e-5;
  rack.send(motion);
}

TEST(Hmc5883lDevice, ReadsTheFieldAsItIsSoldered) {
  BenchRack straight, turned;
  ASSERT_NE(straight.add(compass({"+x", "+y", "+z"})), nullptr) << straight.error;
  ASSERT_NE(turned.add(compass({"-y", "+x", "+z"})), nullptr);
  send_field(straight);
  send_field(turned);
  EXPECT_EQ(measure(straight), (Counts{109, 327, 218}));
  EXPECT_EQ(measure(turned), (Counts{-218, 327, 109}));
  EXPECT_TRUE(straight.findings.empty());
}

TEST(Hmc5883lDevice, TheFramesFieldIsAddedInTheBody) {
  BenchRack rack;
  BoardDevice device = compass({"-y", "+x", "+z"});
  device.set("params.hard_iron", std::vector<double>{1e-4, 0.0, 0.0});
  ASSERT_NE(rack.add(device), nullptr);
  send_field(rack);
  EXPECT_EQ(measure(rack), (Counts{-218, 327, 109 + 1090}));
}

// 10 % more along the nose, and a fifth of each turned to the other between y and z; however it is soldered. What
// a current or the frame itself adds is not bent.
TEST(Hmc5883lDevice, SoftIronBendsTheEarthsFieldInTheBody) {
  for (const bool is_turned : {false, true}) {
    BenchRack rack;
    BoardDevice device = is_turned ? compass({"-y", "+x", "+z"}) : compass({"+x", "+y", "+z"});
    device.set("params.soft_iron", std::vector<double>{0.1, 0.0, 0.0});
    device.set("params.soft_iron_cross", std::vector<double>{0.0, 0.0, 0.2});
    device.set("params.hard_iron", std::vector<double>{1e-4, 0.0, 0.0});
    ASSERT_NE(rack.add(device), nullptr) << rack.error;
    send_field(rack);
    // x 109 + 10.9 + 1090, y 218 + 65.4, z 327 + 43.6
    EXPECT_EQ(measure(rack), is_turned ? (Counts{-283, 371, 1210}) : (Counts{1210, 371, 283}));
  }
}

// 10 A of motor 3 and 20 A of the pack; of the others nothing flows.
TEST(Hmc5883lDevice, CurrentsAddTheirFieldPerAmpere) {
  BenchRack rack;
  BoardDevice device = compass({"+x", "+y", "+z"});
  device.set("params.motor_field_3", std::vector<double>{1e-6, 0.0, -2e-6});
  device.set("params.pack_field", std::vector<double>{0.0, 1e-6, 0.0});
  ASSERT_NE(rack.add(device), nullptr);
  io::BodyMotion motion;
  motion.magnetic_field_B_T[0] = 1e-5;
  motion.rotor_bus_current_A[2] = 10.0;
  motion.battery_current_A = 20.0;
  rack.send(motion);
  EXPECT_EQ(measure(rack), (Counts{218, -218, 218}));
}

TEST(Hmc5883lDevice, ItsDataReadyPinIsToldToTheHarnessOnceAMeasurement) {
  BenchRack rack;
  BoardDevice device = compass({"+x", "+y", "+z"});
  device.set("drdy", "PB1");
  ASSERT_NE(rack.add(device), nullptr);
  std::ignore = measure(rack);
  std::vector<Nanoseconds> times;
  for (io::Reader r(rack.posted.bytes()); r.next();) {
    EXPECT_EQ(r.header().kind, io::Kind::data_ready);
    times.push_back(r.header().t_ns);
  }
  EXPECT_EQ(times, (std::vector<Nanoseconds>{56'000'000, 66'000'000}));
}

TEST(Hmc5883lDevice, ItHasOneAddressAndNeedsItsAxes) {
  BenchRack rack;
  BoardDevice device = compass({"+x", "+y", "+z"});
  device.address = 0x1F;
  EXPECT_EQ(rack.add(device), nullptr);
  EXPECT_EQ(rack.error, "address: 0x1F is outside 0x1E..0x1E");
  device.address = 0x1E;
  device.keys.erase("axes");
  EXPECT_EQ(rack.add(device), nullptr);
  EXPECT_EQ(rack.error, "axes: is missing: a hmc5883l needs it");
}

TEST(Hmc5883lDevice, AFaultFindsItByItsAddress) {
  BenchRack rack;
  ASSERT_NE(rack.add(compass({"+x", "+y", "+z"})), nullptr);
  rack.book.add(
      {.number = 1, .kind = io::FaultKind::sensor_saturated, .bus = 1, .address = 0x1E, .axis = 1});
  send_field(rack);
  EXPECT_EQ(measure(rack), (Counts{109, 327, -4096}));
}

}  // namespace
}  // namespace whirl::rack

#include "base/near.hpp"
#include "io_bridges/devices/tests/ublox_bench.hpp"

namespace whirl::io {
namespace {

constexpr Nanoseconds kSecond = 1'000'000'000;

struct FaultBench : UbloxBench {
  FaultBench() {
    book.on_applied([this](std::uint32_t, Nanoseconds) { ++applied; });
    ubx_only();
    for (const std::uint8_t id : {0x02, 0x06, 0x12}) switch_on(id);
    send(UbxFrame{0x06, 0x08, {0xC8, 0, 1, 0, 0, 0}});
    queue.run_until(9 * kSecond + kSecond / 2);
    forget();
  }
  void add(FaultKind kind, double value, int axis = 0, double from_s = 10.0, double to_s = 20.0) {
    book.add({.number = 1,
              .kind = kind,
              .start_ns = static_cast<Nanoseconds>(from_s * 1e9),
              .end_ns = static_cast<Nanoseconds>(to_s * 1e9),
              .bus = 6,
              .address = 3,
              .axis = axis,
              .value = value});
  }
  double north_m() const {
    return (nav<std::int32_t>(0x02, 8) - 286478898) * 1e-7 / 57.29577951 * 6.37e6;
  }
  int applied = 0;
};

TEST(UbloxFaults, JammedItHasNoFixAndFindsItAgainAfterwards) {
  FaultBench bench;
  bench.add(FaultKind::gnss_jammed, 0.0);
  bench.queue.run_until(15 * kSecond);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 10), 0);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 11), 0x0C);  // it still knows the time
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 47), 0);
  EXPECT_EQ(bench.nav<std::uint32_t>(0x02, 20), 4294967000u);
  bench.queue.run_until(20 * kSecond + kSecond / 2);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 10), 0);
  bench.queue.run_until(21 * kSecond);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 10), 3);
  EXPECT_EQ(bench.applied, 1);
}

TEST(UbloxFaults, SpoofedItDriftsAwayWithAVelocityThatFitsAndFlagsThatAreGood) {
  FaultBench bench;
  bench.truth.v_NED_mps = {};
  bench.add(FaultKind::gnss_spoofed, 2.0);
  bench.queue.run_until(15 * kSecond + kSecond / 6);  // the solution of 15.0 s
  EXPECT_TRUE(near(bench.north_m(), 10.0, stated(0.2, "radius of the earth to 1 %")));
  EXPECT_EQ(bench.nav<std::int32_t>(0x12, 4), 200);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 10), 3);
  EXPECT_EQ(bench.nav<std::uint8_t>(0x06, 11), 0x0D);
}

TEST(UbloxFaults, AnOffsetShiftsItsAxisOnly) {
  FaultBench bench;
  bench.add(FaultKind::sensor_offset, -7.0, 2);
  bench.queue.run_until(15 * kSecond);
  EXPECT_TRUE(near(bench.nav<std::int32_t>(0x02, 12), 257'000, stated(1.0, "mm")));
  EXPECT_TRUE(near(bench.north_m(), 0.0, stated(0.1, "1e-7 deg is 1 cm")));
  FaultBench velocity;
  velocity.add(FaultKind::sensor_offset, 1.0, 4);
  velocity.queue.run_until(15 * kSecond);
  EXPECT_EQ(velocity.nav<std::int32_t>(0x12, 8), -300);
}

TEST(UbloxFaults, FrozenItsTimeGoesOn) {
  FaultBench bench;
  bench.add(FaultKind::sensor_frozen, 0.0);
  bench.queue.run_until(11 * kSecond);
  bench.truth.v_NED_mps = {9.0, 9.0, 9.0};
  const auto before_ms = bench.nav<std::uint32_t>(0x12, 0);
  bench.queue.run_until(12 * kSecond);
  EXPECT_EQ(bench.nav<std::int32_t>(0x12, 4), 300);
  EXPECT_EQ(bench.nav<std::uint32_t>(0x12, 0), before_ms + 1000);
  bench.queue.run_until(21 * kSecond);
  EXPECT_EQ(bench.nav<std::int32_t>(0x12, 4), 900);
}

TEST(UbloxFaults, DropoutsTakeTheirShareAndShiftNoOther) {
  FaultBench bench;
  bench.add(FaultKind::gnss_dropout, 0.3, 0, 10.0, 210.0);
  bench.queue.run_until(210 * kSecond);
  const double came = static_cast<double>(bench.of(1, 2).size());
  EXPECT_TRUE(near(came / 1002.0, 0.7, stated(0.045, "three standard deviations of 1000 draws")));
}

TEST(UbloxFaults, APartThatDropsSolutionsDoesSoByItself) {
  UbloxBench bench;
  bench.params.dropout_chance = 0.5;
  bench.ubx_only();
  bench.switch_on(0x02);
  bench.queue.run_until(1001 * kSecond);
  const double came = static_cast<double>(bench.of(1, 2).size());
  EXPECT_TRUE(near(came / 1000.0, 0.5, stated(0.05, "three standard deviations of 1000 draws")));
}

TEST(UbloxFaults, LateItsSolutionsComeLater) {
  FaultBench bench;
  bench.add(FaultKind::sensor_late, 0.1);
  bench.queue.run_until(10 * kSecond + kSecond / 20);  // the one of 9.8 s is out
  bench.forget();
  bench.queue.run_until(10 * kSecond + kSecond / 5);
  EXPECT_EQ(bench.times.at(0), 10'170'000'000 + 1'041'667);
}

TEST(UbloxFaults, ABrownOutLeavesWhatIsSavedAndAFixWithinASecond) {
  FaultBench bench;
  bench.add(FaultKind::gnss_brown_out, 0.0, 0, 10.0, 10.001);
  bench.queue.run_until(9 * kSecond + 900'000'000);
  EXPECT_TRUE(bench.text.find("$GP") == std::string::npos);
  bench.queue.run_until(10 * kSecond);
  bench.forget();
  bench.queue.run_until(14 * kSecond);
  EXPECT_EQ(bench.applied, 1);
  EXPECT_TRUE(bench.of(0x01, 0x02).empty());  // what it had been told is gone
  EXPECT_NE(bench.text.find("$GPGGA"), std::string::npos);
  EXPECT_TRUE(near(bench.queries.back().error_scale, 1.0 + std::exp(-2.0 / 15.0),
                   stated(0.15, "settling of a hot start, 2 s after its fix, at 1 Hz")));
}

// Rate and model are the part's defaults; what it sends and how is as it was told.
TEST(UbloxFaults, WhoForgetsGoesOnOnceASecondWithTheModelOfAHand) {
  FaultBench bench;
  bench.add(FaultKind::gnss_forgets, 0.0, 0, 10.05, 10.051);
  UbxFrame rate{0x06, 0x08, {200, 0, 1, 0, 1, 0}}, nav5{0x06, 0x24, Bytes(36)};
  nav5.payload[0] = 5, nav5.payload[2] = 6, nav5.payload[3] = 2;
  bench.send(rate);
  bench.send(nav5);
  bench.queue.run_until(10 * kSecond + kSecond / 10);
  bench.forget();
  bench.queue.run_until(14 * kSecond + kSecond / 10);
  EXPECT_EQ(bench.applied, 1);
  EXPECT_EQ(bench.of(0x01, 0x02).size(), 4u);
  bench.send(UbxFrame{0x06, 0x24, {}});
  bench.run(0.2);
  ASSERT_EQ(bench.of(0x06, 0x24).size(), 1u);
  EXPECT_EQ(bench.of(0x06, 0x24)[0].payload[2], 0);
  EXPECT_EQ(bench.of(0x06, 0x24)[0].payload[3], 3);
}

TEST(UbloxFaults, WrongIdentityIsAnotherHardwareVersion) {
  FaultBench bench;
  bench.add(FaultKind::sensor_wrong_identity, 70000.0);
  bench.queue.run_until(11 * kSecond);
  bench.send(UbxFrame{0x0A, 0x04, {}});
  bench.run(0.2);
  const auto version = bench.of(0x0A, 0x04);
  ASSERT_EQ(version.size(), 1u);
  EXPECT_EQ(std::string(version[0].payload.begin() + 30, version[0].payload.begin() + 38),
            "00070000");
}

}  // namespace
}  // namespace whirl::io

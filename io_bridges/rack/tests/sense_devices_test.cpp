// Battery voltage and current as a board's pins show them.
#include <gtest/gtest.h>

#include <set>

#include "base/near.hpp"
#include "io_bridges/rack/tests/bench_rack.hpp"

namespace whirl::rack {
namespace {

io::BodyMotion fed(double bus_V, double battery_A) {
  io::BodyMotion motion;
  motion.bus_voltage_V = bus_V;
  motion.battery_current_A = battery_A;
  return motion;
}

BoardDevice divider(bool exact) {
  BoardDevice device{.name = "battery", .type = "battery_sense", .bus = "PC0"};
  if (exact) {
    device.set("params.tolerance", 0.0);
    device.set("params.noise", 0.0);
  }
  return device;
}

double pin_V(BenchRack& rack) {
  return rack.analog.at("PC0")(rack.queue.now());
}

TEST(BatterySense, TheBoardsDividerGivesTheCountsOfItsDriver) {
  const struct {
    double battery_V;
    int counts;
  } table[] = {{16.8, 3657}, {14.8, 3222}, {11.1, 2417}, {10.5, 2286}};  // 5.7 x 3.3 V / 4095
  for (const auto& row : table) {
    BenchRack rack;
    ASSERT_NE(rack.add(divider(true)), nullptr) << rack.error;
    rack.send(fed(row.battery_V, 0.0));
    rack.run_ms(20.0);
    const double counts = pin_V(rack) / (3.3 / 4095.0);
    EXPECT_TRUE(near(counts, row.counts, stated(0.5, "rounded to a count")));
  }
}

TEST(BatterySense, LagsByTheDividersResistanceAndItsCapacitor) {
  BenchRack rack;
  ASSERT_NE(rack.add(divider(true)), nullptr);
  rack.send(fed(10.0, 0.0));
  rack.run_ms(20.0);
  rack.send(fed(16.0, 0.0));
  rack.run_ms(0.8245614);  // 47 k beside 10 k, times 0.1 uF
  const double share = (pin_V(rack) * 5.7 - 10.0) / 6.0;
  EXPECT_TRUE(near(share, 0.6321206, stated(1e-5, "1 - 1/e, time to a nanosecond")));
}

TEST(BatterySense, AnOffsetIsOfTheBatterysVoltageAndAWireThatIsOffSeesNone) {
  BenchRack rack;
  ASSERT_NE(rack.add(divider(true)), nullptr);
  io::Fault off{.number = 1, .kind = io::FaultKind::sensor_offset, .address = 0, .value = -2.0};
  off.end_ns = 30'000'000;
  rack.book.add(off);
  rack.send(fed(16.0, 0.0));
  rack.run_ms(20.0);
  EXPECT_TRUE(near(pin_V(rack) * 5.7, 14.0, stated(1e-3, "24 time constants")));
  rack.run_ms(20.0);
  off = {.number = 2, .kind = io::FaultKind::sensor_offset, .address = 0, .value = -20.0};
  rack.book.add(off);
  rack.send(fed(16.0, 0.0));
  rack.run_ms(20.0);
  EXPECT_TRUE(near(pin_V(rack), 0.0, stated(1e-3, "24 time constants")));
  EXPECT_TRUE(rack.book.pending().empty());
}

TEST(BatterySense, EachBoardsResistorsDifferWithinTheirTolerance) {
  std::set<double> ratios;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    BenchRack rack(seed);
    BoardDevice device = divider(false);
    device.set("params.noise", 0.0);
    ASSERT_NE(rack.add(device), nullptr);
    rack.send(fed(15.0, 0.0));
    rack.run_ms(20.0);
    const double ratio = 15.0 / pin_V(rack);
    // Two resistors of 1 % against each other: (1 + 4.7 x 1.01 / 0.99).
    EXPECT_TRUE(near(ratio, 5.7, stated(0.096, "1 % each")));
    ratios.insert(ratio);
  }
  EXPECT_EQ(ratios.size(), 20u);
  EXPECT_GT(*ratios.rbegin() - *ratios.begin(), 0.03);
}

BoardDevice hall_of_17_A_per_V() {
  BoardDevice device{.name = "current", .type = "current_sense", .bus = "PC0"};
  device.set("params.gain", 1.0 / 17.0);
  device.set("params.offset", 0.05);
  for (const char* path : {"params.tolerance", "params.offset_error", "params.noise"}) {
    device.set(path, 0.0);
  }
  return device;
}

TEST(CurrentSense, IsGainTimesCurrentAboveItsOffset) {
  BenchRack rack;
  ASSERT_NE(rack.add(hall_of_17_A_per_V()), nullptr) << rack.error;
  EXPECT_TRUE(near(pin_V(rack), 0.05, round_off(2, 0.05)));
  rack.send(fed(15.0, 34.0));
  rack.run_ms(50.0);
  EXPECT_TRUE(near(pin_V(rack), 2.05, round_off(8, 2.05)));
}

// Each for 50 ms, 50 time constants; between them the sensor is well again.
TEST(CurrentSense, FailsAsTheOtherPartsDo) {
  using Kind = io::FaultKind;
  const struct {
    Kind kind;
    double value, pin_V;
  } table[] = {{Kind::sensor_frozen, 0.0, 0.05 + 17.0 / 17.0},  // what it was before 34 A
               {Kind::sensor_offset, -8.5, 0.05 + 25.5 / 17.0},
               {Kind::sensor_offset, -1000.0, 0.0},                         // its wire is off
               {Kind::sensor_drift, 20400.0, 0.05 + (34.0 + 17.0) / 17.0},  // 17 A in 50 ms
               {Kind::sensor_saturated, 0.0, 3.3}};
  for (const auto& row : table) {
    BenchRack rack;
    ASSERT_NE(rack.add(hall_of_17_A_per_V()), nullptr) << rack.error;
    rack.send(fed(15.0, 17.0));
    rack.run_ms(50.0);
    io::Fault fault{.number = 1, .kind = row.kind, .address = 0, .value = row.value};
    fault.start_ns = rack.queue.now();
    fault.end_ns = fault.start_ns + 60'000'000;
    rack.book.add(fault);
    rack.run_ms(50.0);
    rack.send(fed(15.0, 34.0));
    rack.run_ms(9.0);
    EXPECT_TRUE(near(pin_V(rack), row.pin_V, stated(1e-3, "9 time constants of up to 2 V")))
        << io::name(row.kind);
    EXPECT_TRUE(rack.book.pending().empty()) << io::name(row.kind);
    rack.run_ms(2.0);
    rack.send(fed(15.0, 34.0));
    rack.run_ms(50.0);
    EXPECT_TRUE(near(pin_V(rack), 2.05, round_off(8, 2.05))) << io::name(row.kind);
  }
}

TEST(CurrentSense, NeedsItsGainAndAnAnalogPin) {
  BenchRack rack;
  EXPECT_EQ(rack.add({.name = "a", .type = "current_sense", .bus = "PC0"}), nullptr);
  EXPECT_NE(rack.error.find("gain"), std::string::npos);
  BoardDevice device = divider(true);
  device.bus = "PB5";
  EXPECT_EQ(rack.add(device), nullptr);
  EXPECT_NE(rack.error.find("analog"), std::string::npos);
}

}  // namespace
}  // namespace whirl::rack

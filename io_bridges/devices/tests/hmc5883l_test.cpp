// Oracles: HMC5883L data sheet pp. 12, 13, 15 (rates, gains, overflow) and 19 (self test); Honeywell's
// operational examples (6 ms, 56 ms).
#include "io_bridges/devices/hmc5883l.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "io_bridges/devices/tests/hmc5883l_bench.hpp"

namespace whirl::io {
namespace {

using Bytes = HmcBench::Bytes;
using Counts = std::array<int, 3>;  // x, z, y

TEST(Hmc5883l, PowerUpMeasuresOnceAfter56Milliseconds) {
  HmcBench bench;
  bench.run_us(55999);
  EXPECT_EQ(bench.part.samples(), 0u);
  bench.run_us(1);
  EXPECT_EQ(bench.part.samples(), 1u);
  EXPECT_EQ(bench.get(0x02), 0x03);  // idle
  bench.run_us(1e6);
  EXPECT_EQ(bench.part.samples(), 1u);
}

TEST(Hmc5883l, BeforeItsAnalogSideIsUpItMeasuresLater) {
  HmcBench bench;
  bench.run_us(10000);
  bench.set(0x02, 0x01);
  bench.run_us(45999);
  EXPECT_EQ(bench.part.samples(), 0u);
  bench.run_us(1);
  EXPECT_EQ(bench.part.samples(), 1u);
}

TEST(Hmc5883l, ASingleMeasurementTakes6MillisecondsAndThenItIsIdle) {
  HmcBench bench;
  bench.power_up();
  bench.set(0x02, 0x01);
  bench.run_us(5999.999);
  EXPECT_EQ(bench.part.samples(), 1u);
  bench.run_us(0.001);
  EXPECT_EQ(bench.part.samples(), 2u);
  EXPECT_EQ(bench.get(0x02) & 2, 2);
}

TEST(Hmc5883l, IdleMeasuresNothing) {
  for (const int mode : {2, 3}) {
    HmcBench bench;
    bench.power_up();
    bench.set(0x02, 0x00);
    bench.set(0x02, static_cast<std::uint8_t>(mode));
    bench.run_us(1e6);
    EXPECT_EQ(bench.part.samples(), 1u);
  }
}

TEST(Hmc5883l, ContinuousBeginsAfterTwoPeriodsAndGoesOnByOne) {
  const double table_Hz[] = {0.75, 1.5, 3.0, 7.5, 15.0, 30.0, 75.0};
  for (int rate = 0; rate < 7; ++rate) {
    HmcBench bench;
    bench.power_up();
    bench.set(0x00, static_cast<std::uint8_t>(rate << 2));
    bench.set(0x02, 0x00);
    const Nanoseconds started = bench.now();
    bench.run_us(10.5e6 / table_Hz[rate]);
    std::vector<Nanoseconds> falls;
    for (const auto& edge : bench.edges) {
      if (!edge.level) falls.push_back(edge.t_ns);
    }
    ASSERT_EQ(falls.size(), 9u) << rate;
    const double period_ns = 1e9 / table_Hz[rate];
    for (std::size_t i = 0; i < falls.size(); ++i) {
      EXPECT_TRUE(near(static_cast<double>(falls[i] - started),
                       (2.0 + static_cast<double>(i)) * period_ns,
                       stated(10.0, "whole nanoseconds")));
    }
  }
}

TEST(Hmc5883l, ANewRateBeginsAnew) {
  HmcBench bench;
  bench.power_up();
  bench.set(0x02, 0x00);
  bench.run_us(100000);  // of 133 ms to the first at 15 Hz
  bench.set(0x00, 0x18);
  bench.run_us(2e6 / 75.0 - 1.0);
  EXPECT_EQ(bench.part.samples(), 1u);
  bench.run_us(2.0);
  EXPECT_EQ(bench.part.samples(), 2u);
}

TEST(Hmc5883l, DataReadyPulsesLowFor5MicrosecondsAsDataAreThere) {
  HmcBench bench;
  EXPECT_TRUE(bench.drdy.level());
  bench.power_up();
  bench.set(0x02, 0x01);
  const Nanoseconds done = bench.now() + 6'000'000;
  bench.run_us(10000);
  EXPECT_EQ(bench.edges, (std::vector<HmcBench::Edge>{{false, done}, {true, done + 5000}}));
}

TEST(Hmc5883l, OneGaussReadsTheGainInTheOrderXzy) {
  const int table[] = {1370, 1090, 820, 660, 440, 390, 330, 230};
  for (int gain = 0; gain < 8; ++gain) {
    HmcBench bench;
    bench.power_up();
    bench.set_gain(gain);
    bench.field_T = {1e-4, -1e-4, 0.5e-4};
    EXPECT_EQ(bench.measure(), (Counts{table[gain], table[gain] / 2, -table[gain]})) << gain;
  }
}

TEST(Hmc5883l, TheFirstMeasurementAfterAGainChangeHasTheOldGain) {
  HmcBench bench;
  bench.power_up();
  bench.field_T = {1e-4, 0.0, 0.0};
  bench.set(0x01, 0xA0);
  EXPECT_EQ(bench.measure(), (Counts{1090, 0, 0}));
  EXPECT_EQ(bench.measure(), (Counts{390, 0, 0}));
}

TEST(Hmc5883l, OverflowReadsMinus4096OnItsAxisAndClearsWithTheNext) {
  HmcBench bench;
  bench.power_up();
  bench.field_T = {2047.4 / 1090 * 1e-4, -2048.4 / 1090 * 1e-4, 0.0};
  EXPECT_EQ(bench.measure(), (Counts{2047, 0, -2048}));
  bench.field_T = {2047.6 / 1090 * 1e-4, -2048.6 / 1090 * 1e-4, 0.0};
  EXPECT_EQ(bench.measure(), (Counts{-4096, 0, -4096}));
  EXPECT_EQ(bench.read(0x03, 2), (Bytes{0xF0, 0x00}));
  bench.read(0x03, 6);
  bench.field_T = {0.0, 0.0, 0.0};
  EXPECT_EQ(bench.measure(), (Counts{0, 0, 0}));
}

TEST(Hmc5883l, SelfTestShowsTheStrapsAndNotTheFieldAround) {
  for (const int sign : {1, -1}) {
    HmcBench bench;
    bench.power_up();
    bench.set_gain(5);
    bench.set(0x00, static_cast<std::uint8_t>(0x70 | (sign > 0 ? 1 : 2)));
    EXPECT_EQ(bench.measure(), (Counts{452 * sign, 421 * sign, 452 * sign}));
    bench.set(0x00, 0x70);
    EXPECT_EQ(bench.measure(), (Counts{39, -117, 78}));  // 0.1, -0.3 and 0.2 Ga at 390 each
  }
}

TEST(Hmc5883l, SelfTestThatOverflowsReadsMinus4096) {
  HmcBench bench;
  bench.power_up();
  bench.field_T = {0.8e-4, 0.0, 0.0};  // with 1.16 Ga beyond the 1.88 Ga of the default gain
  bench.set(0x00, 0x11);
  EXPECT_EQ(bench.measure(), (Counts{-4096, 1177, 1264}));
}

// Noise of 0.8 Ga: 1.88 Ga is the rail. In the self test the field around, -1.1 Ga, leaves room for a
// difference that is beyond it.
TEST(Hmc5883l, NoNoiseCarriesCountsBeyondTheRails) {
  for (const bool self_test : {false, true}) {
    HmcBench bench(0.8e-4);
    bench.power_up();
    bench.set(0x00, self_test ? 0x11 : 0x10);
    bench.field_T = {self_test ? -1.1e-4 : 1.5e-4, 0.0, 0.0};
    int within = 0, beyond = 0;
    for (int i = 0; i < 300; ++i) {
      const int x = bench.measure()[0];
      (x == -4096 ? beyond : within) += 1;
      EXPECT_TRUE(x == -4096 || (x >= -2048 && x <= 2047)) << x;
    }
    EXPECT_GT(within, 30);
    EXPECT_GT(beyond, 30);
  }
}

TEST(Hmc5883l, NoiseFallsWithTheRootOfTheAverages) {
  for (int averages = 0; averages < 4; ++averages) {
    HmcBench bench(2e-7);
    bench.power_up();
    bench.set_gain(0);  // 0.073 uT a count
    bench.set(0x00, static_cast<std::uint8_t>(averages << 5 | 0x10));
    bench.field_T = {0.0, 0.0, 0.0};
    constexpr int kSamples = 3000;
    double sum = 0.0, product = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const Counts got = bench.measure();
      for (const int counts : got) sum += std::pow(counts / 1370.0 * 1e-4, 2);
      product += got[0] * got[1] / (1370.0 * 1370.0) * 1e-8;
    }
    // Rounding to whole counts adds a twelfth of a count squared.
    const double white = 2e-7 / std::sqrt(1 << averages), count_T = 1e-4 / 1370.0;
    const double want = std::sqrt(white * white + count_T * count_T / 12.0);
    EXPECT_TRUE(near(std::sqrt(sum / (3 * kSamples)), want, stated(0.04 * want, "five sigma")));
    EXPECT_TRUE(near(product / kSamples / (want * want), 0.0, stated(0.09, "five sigma")));
  }
}

TEST(Hmc5883l, TheSameSeedGivesTheSameNoise) {
  HmcBench a(1e-6, 1), b(1e-6, 1), c(1e-6, 2);
  for (HmcBench* bench : {&a, &b, &c}) bench->power_up();
  const Counts first = a.measure();
  EXPECT_EQ(first, b.measure());
  const Counts other = c.measure();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NE(first[i], other[i]) << i;
}

// PX4: identity, gain code 2 read back, then every 6.67 ms a single measurement and six bytes.
TEST(Hmc5883l, ADriversPolledSequenceGivesWhatIsThere) {
  HmcBench bench;
  bench.power_up();
  EXPECT_EQ(bench.read(0x0A, 3), (Bytes{'H', '4', '3'}));
  bench.set(0x01, 0x40);
  EXPECT_EQ(bench.get(0x01), 0x40);
  for (int i = 0; i < 20; ++i) {
    const double turned_T = 1e-6 * i;
    bench.field_T = {2e-5 + turned_T, turned_T, 4e-5};
    bench.set(0x02, 0x01);
    bench.run_us(6667);
    const Counts got = bench.data();
    if (i == 0) continue;  // the old gain
    EXPECT_TRUE(near(got[0] / 820.0 * 1e-4, bench.field_T[0], counts(0.51, 1e-4 / 820.0)));
    EXPECT_TRUE(near(got[2] / 820.0 * 1e-4, bench.field_T[1], counts(0.51, 1e-4 / 820.0)));
    EXPECT_EQ(got[1], 328);
  }
  EXPECT_TRUE(bench.findings.empty());
}

// ---- Faults

Fault fault(FaultKind kind, double value = 0.0, int axis = 0) {
  return {.number = 7, .kind = kind, .bus = 2, .address = 0x1E, .axis = axis, .value = value};
}

TEST(Hmc5883lFault, FrozenGoesOnSignallingAndDataStay) {
  HmcBench bench;
  bench.power_up();
  const Counts before = bench.measure();
  bench.faults.add(fault(FaultKind::sensor_frozen));
  bench.field_T = {0.0, 0.0, 0.0};
  bench.edges.clear();
  EXPECT_EQ(bench.measure(), before);
  EXPECT_EQ(bench.get(0x09), 0x01);
  EXPECT_FALSE(bench.edges.empty());
  EXPECT_TRUE(bench.faults.pending().empty());
}

TEST(Hmc5883lFault, OffsetAndSaturationActOnTheirAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t at = axis == 0 ? 0 : axis == 1 ? 2 : 1;  // x, z, y
    HmcBench bench;
    bench.power_up();
    const Counts before = bench.measure();
    Fault offset = fault(FaultKind::sensor_offset, 1e-4, axis);
    offset.end_ns = bench.now() + 7'000'000;
    bench.faults.add(offset);
    Counts want = before;
    want[at] += 1090;
    EXPECT_EQ(bench.measure(), want) << axis;
    bench.run_us(1000);
    bench.faults.add(fault(FaultKind::sensor_saturated, 0.0, axis));
    want = before;
    want[at] = -4096;
    EXPECT_EQ(bench.measure(), want) << axis;
  }
}

TEST(Hmc5883lFault, DriftGrowsByItsValueEachMinute) {
  HmcBench bench;
  bench.power_up();
  Counts want = bench.measure();
  bench.run_us(30'000'000);
  Fault drift = fault(FaultKind::sensor_drift, 2e-4, 0);  // 1 Ga in half a minute
  drift.start_ns = bench.now() - 30'000'000'000;
  bench.faults.add(drift);
  want[0] += 1090;
  EXPECT_TRUE(near(bench.measure()[0], want[0], counts(2, 1.0)));
}

TEST(Hmc5883lFault, WrongIdentityReadsItsValue) {
  HmcBench bench;
  bench.faults.add(fault(FaultKind::sensor_wrong_identity, 0x49));
  EXPECT_EQ(bench.read(0x0A, 3), (Bytes{0x49, '4', '3'}));
}

TEST(Hmc5883lFault, LateComesLater) {
  HmcBench bench;
  bench.power_up();
  bench.faults.add(fault(FaultKind::sensor_late, 0.010));
  bench.set(0x02, 0x01);
  bench.run_us(15999);
  EXPECT_EQ(bench.part.samples(), 1u);
  bench.run_us(1);
  EXPECT_EQ(bench.part.samples(), 2u);
}

TEST(Hmc5883lFault, OfAnotherPartDoesNothing) {
  HmcBench bench;
  bench.power_up();
  const Counts before = bench.measure();
  Fault other = fault(FaultKind::sensor_saturated);
  other.address = 0x77;
  bench.faults.add(other);
  EXPECT_EQ(bench.measure(), before);
  EXPECT_EQ(bench.faults.pending().size(), 1u);
}

TEST(Hmc5883lFault, TheBusHasItsOwn) {
  HmcBench bench;
  Fault nack = fault(FaultKind::i2c_nack);
  nack.end_ns = 1;
  bench.faults.add(nack);
  EXPECT_FALSE(bench.write({0x02, 0x00}));
  bench.run_us(1);
  EXPECT_EQ(bench.get(0x02), 0x01);
}

TEST(Hmc5883l, ABrownOutLosesItsSettingsAndBeginsAsAtPowerUp) {
  HmcBench bench;
  bench.power_up();
  bench.set(0x01, 0xE0);
  bench.set(0x02, 0x00);
  const Nanoseconds from = bench.now();
  bench.faults.add({.number = 1,
                    .kind = FaultKind::sensor_brown_out,
                    .start_ns = from + 1'000'000,
                    .end_ns = from + 2'000'000,
                    .bus = 2,
                    .address = 0x1E});
  bench.run_us(1500);
  EXPECT_FALSE(bench.write({0x02}));
  bench.run_us(600);
  EXPECT_EQ(bench.get(0x01), 0x20);
  const std::uint64_t before = bench.part.samples();
  bench.run_us(57'000);
  EXPECT_EQ(bench.part.samples(), before + 1);  // the single one of power-up
  EXPECT_EQ(bench.get(0x02), 0x03);
  EXPECT_TRUE(bench.faults.pending().empty());
}

}  // namespace
}  // namespace whirl::io

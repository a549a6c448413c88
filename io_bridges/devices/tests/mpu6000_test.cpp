// Oracles: PS-MPU-6000A-00 rev 3.4 and RM-MPU-6000A-00 rev 4.2 (tables, register descriptions).
#include "io_bridges/devices/mpu6000.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"
#include "io_bridges/devices/i2c_bus.hpp"
#include "io_bridges/devices/tests/mpu6000_bench.hpp"

namespace whirl::io {
namespace {

constexpr double kRadps_per_degps = 3.14159265358979 / 180.0;

TEST(Mpu6000, ResetValuesAreZeroButForPowerAndIdentity) {
  MpuBench bench;
  EXPECT_EQ(bench.read(0x75), 0x68);  // WHO_AM_I
  EXPECT_EQ(bench.read(0x6B), 0x40);  // PWR_MGMT_1: asleep
  for (const std::uint8_t address : {0x19, 0x1A, 0x1B, 0x1C, 0x23, 0x37, 0x38, 0x3A, 0x6A, 0x6C}) {
    EXPECT_EQ(bench.read(address), 0x00) << int{address};
  }
  const std::uint8_t product = bench.read(0x0C);  // Betaflight accepts 0x14..0x18, 0x54..0x5A
  EXPECT_TRUE((product >= 0x14 && product <= 0x18) || (product >= 0x54 && product <= 0x5A));
  EXPECT_TRUE(bench.findings.empty());
}

TEST(Mpu6000, AsleepItNeitherSamplesNorSignals) {
  MpuBench bench;
  bench.write(0x38, 0x01);
  bench.run(500);
  EXPECT_EQ(bench.part.samples(), 0u);
  EXPECT_TRUE(bench.rises.empty());
}

TEST(Mpu6000, FirstSampleComesThirtyMillisecondsAfterWaking) {
  MpuBench bench;
  bench.write(0x38, 0x01);
  const Nanoseconds woken = bench.queue.now();
  bench.write(0x6B, 0x01);
  bench.run(29.9);
  EXPECT_TRUE(bench.rises.empty());
  bench.run(0.2);
  ASSERT_FALSE(bench.rises.empty());
  EXPECT_EQ(bench.rises[0], woken + 30'000'000);
}

TEST(Mpu6000, RegistersAreDeadWhileItStartsAndAWriteIsLost) {
  MpuBench bench;
  bench.write(0x19, 4);
  bench.write(0x6B, 0x80);
  EXPECT_EQ(bench.read(0x75), 0x00);
  EXPECT_EQ(bench.read(0x6B) & 0x80, 0x80);
  bench.write(0x19, 9);
  EXPECT_EQ(bench.findings.size(), 1u);
  bench.run(100);
  EXPECT_EQ(bench.read(0x19), 0x00);
  EXPECT_EQ(bench.read(0x6B), 0x40);
  EXPECT_EQ(bench.read(0x75), 0x68);
}

TEST(Mpu6000, SampleRateIsTheGyroRateOverOnePlusDivider) {
  const int table[][3] = {{0, 0, 8000}, {0, 7, 1000}, {1, 0, 1000}, {3, 3, 250}, {6, 199, 5}};
  for (const auto& [dlpf, divider, rate_Hz] : table) {
    MpuBench bench;
    bench.wake();
    bench.write(0x1A, static_cast<std::uint8_t>(dlpf));
    bench.write(0x19, static_cast<std::uint8_t>(divider));
    bench.run(400);
    const std::uint64_t before = bench.part.samples();
    bench.run(1000);
    EXPECT_EQ(bench.part.samples() - before, static_cast<std::uint64_t>(rate_Hz)) << dlpf;
  }
}

TEST(Mpu6000, SamplePeriodIsExactOnItsOwnClock) {
  Mpu6000::Params params = MpuBench::exact();
  params.pll_clock_error = 0.01;
  MpuBench bench(params);
  bench.wake();
  bench.run(100);
  ASSERT_GT(bench.rises.size(), 50u);
  for (std::size_t i = 1; i < bench.rises.size(); ++i) {
    EXPECT_TRUE(near(static_cast<double>(bench.rises[i] - bench.rises[i - 1]), 1.01e6,
                     stated(1.0, "whole nanoseconds")));
  }
}

TEST(Mpu6000, OneGReadsTheSensitivityOfEachRange) {
  const int table[] = {16384, 8192, 4096, 2048};
  for (int afs = 0; afs < 4; ++afs) {
    MpuBench bench;
    bench.truth.specific_force_mps2 = {9.80665, -9.80665, 0.0};
    bench.write(0x1C, static_cast<std::uint8_t>(afs << 3));
    bench.wake();
    EXPECT_EQ(bench.word(0x3B), table[afs]);
    EXPECT_EQ(bench.word(0x3D), -table[afs]);
    EXPECT_EQ(bench.word(0x3F), 0);
  }
}

TEST(Mpu6000, HundredDegreesPerSecondReadTheSensitivityOfEachRange) {
  const double table[] = {131.0, 65.5, 32.8, 16.4};
  for (int fs = 0; fs < 4; ++fs) {
    MpuBench bench;
    bench.truth.rate_radps = {0.0, 100.0 * kRadps_per_degps, -100.0 * kRadps_per_degps};
    bench.write(0x1B, static_cast<std::uint8_t>(fs << 3));
    bench.wake();
    EXPECT_TRUE(near(bench.word(0x45), 100.0 * table[fs], counts(0.5, 1.0)));
    EXPECT_TRUE(near(bench.word(0x47), -100.0 * table[fs], counts(0.5, 1.0)));
  }
}

TEST(Mpu6000, ClipsAtTheRailsInsteadOfWrapping) {
  MpuBench bench;
  bench.truth.specific_force_mps2 = {25.0, -25.0, 0.0};  // beyond 2 g
  bench.wake();
  EXPECT_EQ(bench.word(0x3B), 32767);
  EXPECT_EQ(bench.word(0x3D), -32768);
}

TEST(Mpu6000, TemperatureReadsMinus521At35Degrees) {
  MpuBench bench;
  bench.truth.temperature_K = 273.15 + 35.0;
  bench.wake();
  EXPECT_TRUE(near(bench.word(0x41), -521, counts(1, 1.0)));
}

TEST(Mpu6000, OneBurstIsOneInstantEvenWhenASampleFallsIntoIt) {
  MpuBench bench;
  bench.wake();
  bench.part.select(true, bench.queue.now());
  bench.part.transfer(0xBB, 1'000'000, 0, bench.queue.now());
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 6; ++i) {
    bytes.push_back(bench.part.transfer(0, 1'000'000, 0, bench.queue.now()));
    bench.truth.specific_force_mps2 = {5.0, 5.0, 5.0};
    bench.run(30);
  }
  bench.part.select(false, bench.queue.now());
  EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0, 0, 0, 0, 0x40, 0x00}));  // 1 g at 16384
  EXPECT_NE(bench.word(0x3B), 0);
}

TEST(Mpu6000, DataReadyPulseLastsFiftyMicroseconds) {
  MpuBench bench;
  bench.wake();
  bench.run(1.0);
  ASSERT_EQ(bench.rises.size(), 1u);
  bench.queue.run_until(bench.rises[0] + 1'049'999);
  EXPECT_TRUE(bench.interrupt.level());
  bench.queue.run_until(bench.rises[0] + 1'050'000);
  EXPECT_FALSE(bench.interrupt.level());
}

TEST(Mpu6000, LatchedInterruptHoldsUntilStatusIsRead) {
  MpuBench bench;
  bench.write(0x37, 0x20);
  bench.wake();
  EXPECT_TRUE(bench.interrupt.level());
  bench.read(0x3B);
  EXPECT_TRUE(bench.interrupt.level());
  EXPECT_EQ(bench.read(0x3A) & 0x01, 0x01);
  EXPECT_FALSE(bench.interrupt.level());
  EXPECT_EQ(bench.read(0x3A) & 0x01, 0x00);
}

TEST(Mpu6000, WithRdClearAnyReadReleasesTheLatchedInterrupt) {
  MpuBench bench;
  bench.write(0x37, 0x30);
  bench.wake();
  EXPECT_TRUE(bench.interrupt.level());
  bench.read(0x3B);
  EXPECT_FALSE(bench.interrupt.level());
}

TEST(Mpu6000, ActiveLowTurnsTheLineRound) {
  MpuBench bench;
  bench.write(0x37, 0xA0);
  EXPECT_TRUE(bench.interrupt.level());
  bench.wake();
  EXPECT_FALSE(bench.interrupt.level());
}

TEST(Mpu6000, FifoKeepsRegisterOrderAndCountsBytes) {
  MpuBench bench;
  bench.truth.specific_force_mps2 = {9.80665, 0.0, 0.0};
  bench.truth.rate_radps = {0.0, 0.0, 10.0 * kRadps_per_degps};  // 1310 counts
  bench.wake();
  bench.write(0x23, 0x78);  // accelerometer and the three gyros
  bench.write(0x6A, 0x40);
  bench.run(3.0);
  EXPECT_EQ(bench.word(0x72), 3 * 12);
  std::vector<std::uint8_t> request(1 + 12, 0);
  request[0] = 0x80 | 0x74;  // the address stays at FIFO_R_W
  auto bytes = bench.spi(request);
  bytes.erase(bytes.begin());
  EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0x40, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x05, 0x1E}));
  EXPECT_EQ(bench.word(0x72), 2 * 12);
}

TEST(Mpu6000, FullFifoLosesTheOldestAndSaysSo) {
  MpuBench bench;
  bench.wake();
  bench.write(0x23, 0x10);  // gyro z: two bytes a sample
  bench.write(0x6A, 0x40);
  bench.run(512);
  EXPECT_EQ(bench.read(0x3A) & 0x10, 0);
  bench.truth.rate_radps[2] = 1.0;
  bench.run(100);
  EXPECT_EQ(bench.read(0x3A) & 0x10, 0x10);
  EXPECT_EQ(bench.word(0x72), 1024);
  bench.write(0x6A, 0x04);
  EXPECT_EQ(bench.word(0x72), 0);
  EXPECT_EQ(bench.read(0x6A), 0x00);  // FIFO_RESET clears itself
}

TEST(Mpu6000, ConfigurationAboveOneMegahertzIsAFindingSensorReadsAreNot) {
  MpuBench bench;
  bench.wake();
  bench.spi({0xBB, 0, 0}, 20'000'000);
  EXPECT_TRUE(bench.findings.empty());
  bench.spi({0x80 | 0x75, 0}, 10'000'000);
  EXPECT_EQ(bench.findings.size(), 1u);
  bench.spi({0x19, 1}, 2'000'000);
  EXPECT_EQ(bench.findings.size(), 2u);
  bench.spi({0xBB, 0}, 42'000'000);
  EXPECT_EQ(bench.findings.size(), 3u);
}

TEST(Mpu6000, StrangeFirmwareIsNeverMetWithSilence) {
  const std::vector<std::vector<std::uint8_t>> strange = {
      {0x11, 1},         // reserved address
      {0x75, 1},         // read-only
      {0x80 | 0x7F, 0},  // read of a reserved address
      {0x6C, 0x07},      // standby per axis: stored only
      {0x1A, 0x07},      // reserved filter
      {0x6B, 0x04},      // external clock that is not there
      {0x6A, 0x80},      // DMP
  };
  for (const auto& frame : strange) {
    MpuBench bench;
    bench.spi(frame);
    EXPECT_EQ(bench.findings.size(), 1u) << int{frame[0]};
  }
  MpuBench bench;
  bench.spi({0x80 | 0x75, 0}, 1'000'000, 1);
  EXPECT_EQ(bench.findings.size(), 1u);
}

TEST(Mpu6000, AnswersOnI2cUntilI2cIsSwitchedOff) {
  MpuBench bench;
  I2cBus bus("I2C1");
  bus.add(bench.part);
  const Nanoseconds now = bench.queue.now();
  bus.start(now);
  ASSERT_TRUE(bus.address(0x68, false, now));
  bus.write(0x75, now);
  bus.start(now);
  ASSERT_TRUE(bus.address(0x68, true, now));
  EXPECT_EQ(bus.read(false, now), 0x68);
  bus.stop(now);
  bench.write(0x6A, 0x10);
  bus.start(now);
  EXPECT_FALSE(bus.address(0x68, false, now));
}

TEST(Mpu6000, AStepReachesTheRegistersAfterTheFiltersDelay) {
  MpuBench bench;
  bench.wake();  // DLPF 3: gyro 42 Hz, 4.8 ms
  bench.truth.rate_radps[0] = 100.0 * kRadps_per_degps;
  bench.run(1.0);
  EXPECT_LT(bench.word(0x43), 0.15 * 13100);
  bench.run(8.0);
  EXPECT_GT(bench.word(0x43), 0.75 * 13100);
  bench.run(60.0);
  EXPECT_TRUE(near(bench.word(0x43), 13100, counts(1, 1.0)));
}

TEST(Mpu6000Fault, FrozenGoesOnSignallingWithOldData) {
  MpuBench bench;
  bench.wake();
  bench.faults.add({.number = 1, .kind = FaultKind::sensor_frozen, .start_ns = bench.queue.now()});
  bench.truth.specific_force_mps2 = {9.80665, 0.0, 0.0};
  bench.run(100);
  EXPECT_EQ(bench.word(0x3B), 0);
  EXPECT_EQ(bench.rises.size(), 100u);
  EXPECT_TRUE(bench.faults.pending().empty());
}

TEST(Mpu6000Fault, OffsetRailAndWrongIdentity) {
  MpuBench bench;
  bench.wake();
  const Nanoseconds now = bench.queue.now();
  bench.faults.add({.number = 1,
                    .kind = FaultKind::sensor_offset,
                    .start_ns = now,
                    .axis = 1,
                    .value = 9.80665});
  bench.faults.add({.number = 2, .kind = FaultKind::sensor_saturated, .start_ns = now, .axis = 5});
  bench.faults.add(
      {.number = 3, .kind = FaultKind::sensor_wrong_identity, .start_ns = now, .value = 0x71});
  bench.run(2);
  EXPECT_EQ(bench.word(0x3D), 16384);
  EXPECT_EQ(bench.word(0x3B), 0);
  EXPECT_EQ(bench.word(0x47), 32767);
  EXPECT_EQ(bench.read(0x75), 0x71);
  EXPECT_TRUE(bench.faults.pending().empty());
}

TEST(Mpu6000Fault, DriftCountsFromItsStart) {
  MpuBench bench;
  bench.wake();
  bench.run(500);
  bench.faults.add({.number = 1,
                    .kind = FaultKind::sensor_drift,
                    .start_ns = bench.queue.now(),
                    .axis = 1,
                    .value = 9.80665 * 60.0});
  bench.run(2);
  EXPECT_TRUE(near(bench.word(0x3D), 0.0, counts(66, 1.0)));  // 2 ms of 1 g a second, and a sample
  bench.run(498);
  EXPECT_TRUE(
      near(bench.word(0x3D), 8192.0, counts(33, 1.0)));  // half a second, of samples of 1 ms
  EXPECT_EQ(bench.word(0x3B), 0);
}

TEST(Mpu6000, AnAxisOfAnotherScaleReadsByThatShareMore) {
  MpuBench bench;
  bench.wake();
  bench.run(2);
  const auto before = bench.word(0x3F);
  ASSERT_EQ(before, 16384);  // 1 g along z
  bench.faults.add({.number = 1,
                    .kind = FaultKind::sensor_scale,
                    .start_ns = bench.queue.now(),
                    .axis = 2,
                    .value = 0.03});
  bench.run(2);
  EXPECT_EQ(bench.word(0x3F), std::lround(1.03 * 16384.0));
  EXPECT_EQ(bench.word(0x3B), 0);
  EXPECT_TRUE(bench.faults.pending().empty());
}

// The start-up of real drivers must not produce a finding or a surprise.
TEST(Mpu6000, BetaflightsStartUpPasses) {
  MpuBench bench;
  bench.write(0x6B, 0x80);
  bench.run(100);
  bench.write(0x68, 0x07);
  bench.run(100);
  EXPECT_EQ(bench.read(0x75), 0x68);
  for (const auto& [a, v] : {std::pair{0x6B, 0x03},
                             {0x6A, 0x10},
                             {0x6C, 0x00},
                             {0x19, 0x00},
                             {0x1B, 0x18},
                             {0x1C, 0x18},
                             {0x37, 0x10},
                             {0x38, 0x01},
                             {0x1A, 0x00}}) {
    bench.write(static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(v));
    bench.run(0.015);
  }
  bench.run(50);
  EXPECT_EQ(bench.word(0x3F), 2048);
  EXPECT_TRUE(bench.findings.empty());
}

TEST(Mpu6000, ABrownOutPutsItToSleepWithItsFirstSettings) {
  MpuBench bench;
  bench.wake();
  EXPECT_EQ(bench.read(0x6B), 0x01);
  const Nanoseconds from = bench.queue.now();
  bench.faults.add({.number = 1,
                    .kind = FaultKind::sensor_brown_out,
                    .start_ns = from + 1'000'000,
                    .end_ns = from + 5'000'000});
  bench.run(2);
  EXPECT_EQ(bench.read(0x75), 0xFF);  // nobody drives the line
  bench.run(20);
  bench.rises.clear();
  EXPECT_EQ(bench.read(0x6B), 0x40);
  EXPECT_EQ(bench.read(0x1A), 0x00);
  bench.run(100);
  EXPECT_TRUE(bench.rises.empty());
}

}  // namespace
}  // namespace whirl::io

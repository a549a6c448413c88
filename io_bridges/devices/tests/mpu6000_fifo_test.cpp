// The MPU-6000's FIFO, by RM-MPU-6000A-00 rev 4.2: 4.7 FIFO_EN, 4.27 USER_CTRL, 4.30 FIFO_COUNT,
// 4.31 FIFO_R_W.
#include <gtest/gtest.h>

#include "io_bridges/devices/tests/mpu6000_bench.hpp"

namespace whirl::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes burst(MpuBench& bench, std::size_t length) {
  Bytes frame(1 + length, 0);
  frame[0] = 0x80 | 0x74;
  frame = bench.spi(frame);
  frame.erase(frame.begin());
  return frame;
}

// 0.5 g, 36.53 + 10 degC, 1, 2, 3 deg/s: 0x2000, 3400, 131, 262, 393 counts.
void set_truth(MpuBench& bench) {
  constexpr double kRadps_per_degps = 0.017453292519943295;
  bench.truth.specific_force_mps2 = {9.80665 / 2.0, 0.0, 0.0};
  bench.truth.temperature_K = 273.15 + 46.53;
  for (std::size_t i = 0; i < 3; ++i) {
    bench.truth.rate_radps[i] = static_cast<double>(i + 1) * kRadps_per_degps;
  }
}

TEST(Mpu6000Fifo, EachBitOfFifoEnBringsItsWordsInRegisterOrder) {
  const Bytes accel{0x20, 0, 0, 0, 0, 0}, temperature{0x0D, 0x48}, x{0, 0x83}, y{0x01, 0x06},
      z{0x01, 0x89};
  const struct {
    std::uint8_t bit;
    const Bytes& words;
  } in_order[] = {{0x08, accel}, {0x80, temperature}, {0x40, x}, {0x20, y}, {0x10, z}};
  for (std::uint8_t combination = 1; combination < 32; ++combination) {
    MpuBench bench;
    set_truth(bench);
    bench.wake();
    std::uint8_t enable = 0;
    Bytes want;
    for (unsigned i = 0; i < 5; ++i) {
      if ((combination >> i & 1) == 0) continue;
      enable = static_cast<std::uint8_t>(enable | in_order[i].bit);
      want.insert(want.end(), in_order[i].words.begin(), in_order[i].words.end());
    }
    bench.write(0x23, enable);
    bench.write(0x6A, 0x40);
    bench.run(2.0);
    EXPECT_EQ(bench.word(0x72), 2 * std::ssize(want));
    EXPECT_EQ(burst(bench, want.size()), want) << int{combination};
    EXPECT_EQ(burst(bench, want.size()), want) << int{combination};
    EXPECT_EQ(bench.word(0x72), 0);
    EXPECT_TRUE(bench.findings.empty());
  }
}

TEST(Mpu6000Fifo, AnEmptyOneGivesItsLastByteAgain) {
  MpuBench bench;
  set_truth(bench);
  bench.wake();
  bench.write(0x23, 0x10);
  bench.write(0x6A, 0x40);
  bench.run(1.0);
  EXPECT_EQ(burst(bench, 5), (Bytes{0x01, 0x89, 0x89, 0x89, 0x89}));
}

TEST(Mpu6000Fifo, TheLowByteOfTheCountIsLatchedByReadingTheHighOne) {
  MpuBench bench;
  bench.wake();
  bench.write(0x23, 0x78);
  bench.write(0x6A, 0x40);
  bench.run(1.0);
  EXPECT_EQ(bench.read(0x72), 0);
  bench.run(1.0);
  EXPECT_EQ(bench.read(0x73), 12);
  EXPECT_EQ(bench.read(0x72), 0);
  EXPECT_EQ(bench.read(0x73), 24);
}

TEST(Mpu6000Fifo, OverflowRaisesTheInterruptWhenItIsEnabled) {
  for (const bool enabled : {false, true}) {
    MpuBench bench;
    bench.wake();
    bench.write(0x38, enabled ? 0x10 : 0x00);
    bench.write(0x23, 0x08);  // six bytes a sample: 170 fit
    bench.write(0x6A, 0x40);
    bench.run(170.5);
    EXPECT_EQ(bench.rises.size(), 0u);
    EXPECT_EQ(bench.read(0x3A) & 0x10, 0);
    bench.run(1.0);
    EXPECT_EQ(bench.rises.size(), enabled ? 1u : 0u);
    EXPECT_EQ(bench.word(0x72), 1024);
    EXPECT_EQ(bench.read(0x3A) & 0x10, 0x10);
    EXPECT_EQ(bench.read(0x3A), 0);  // reading clears
  }
}

TEST(Mpu6000Fifo, WhenFullTheOldestBytesGo) {
  MpuBench bench;
  bench.wake();
  bench.write(0x23, 0x08);
  bench.write(0x6A, 0x40);
  bench.run(171.5);
  set_truth(bench);  // 171 samples of 9.81 in z so far: two bytes of the first are gone
  const Bytes got = burst(bench, 1024);
  EXPECT_EQ(Bytes(got.begin(), got.begin() + 4), (Bytes{0, 0, 0x40, 0}));
  EXPECT_EQ(Bytes(got.end() - 6, got.end()), (Bytes{0, 0, 0, 0, 0x40, 0}));
}

TEST(Mpu6000Fifo, IsOutOfReachWhileItIsDisabledAndKeepsWhatItHas) {
  MpuBench bench;
  set_truth(bench);
  bench.wake();
  bench.write(0x23, 0x10);
  bench.write(0x6A, 0x40);
  bench.run(2.0);
  bench.write(0x6A, 0x00);
  bench.run(5.0);
  EXPECT_EQ(burst(bench, 2), (Bytes{0, 0}));
  EXPECT_EQ(bench.findings.size(), 1u);
  EXPECT_EQ(bench.word(0x72), 4);
  bench.write(0x6A, 0x40);
  EXPECT_EQ(burst(bench, 4), (Bytes{0x01, 0x89, 0x01, 0x89}));
}

TEST(Mpu6000Fifo, ReadingItClearsALatchedInterruptWhenAnyReadDoes) {
  MpuBench bench;
  bench.wake();
  bench.write(0x37, 0x30);  // held, any read clears
  bench.write(0x23, 0x10);
  bench.write(0x6A, 0x40);
  bench.run(1.2);
  EXPECT_TRUE(bench.interrupt.level());
  burst(bench, 2);
  EXPECT_FALSE(bench.interrupt.level());
}

TEST(Mpu6000Fifo, Px4sStartUpPassesAndItsFifoHoldsEachAccelerationEightTimes) {
  MpuBench bench;
  bench.write(0x6B, 0x80);
  bench.run(100);
  EXPECT_EQ(bench.read(0x75), 0x68);
  EXPECT_EQ(bench.read(0x6B), 0x40);
  bench.write(0x6B, 0x01);
  bench.write(0x68, 0x07);
  bench.write(0x6A, 0x11);
  bench.run(100);
  const std::pair<std::uint8_t, std::uint8_t> settings[] = {
      {0x1B, 0x18}, {0x1C, 0x18}, {0x23, 0x78}, {0x37, 0x80}, {0x38, 0x01}, {0x6A, 0x50}};
  for (const auto& [address, value] : settings) bench.write(address, bench.read(address) | value);
  for (const auto& [address, value] : settings) {
    EXPECT_EQ(bench.read(address) & value, value) << int{address};
  }
  bench.write(0x6A, 0x54);        // FIFO_RESET
  for (int i = 0; i < 50; ++i) {  // 5 ms at 8 kHz while the vehicle shakes
    bench.truth.specific_force_mps2[0] = i % 2 == 0 ? 20.0 : -20.0;
    bench.run(0.1);
  }
  const int length = bench.word(0x72);
  ASSERT_EQ(length, 40 * 12);
  std::vector<std::uint8_t> fifo(1 + static_cast<std::size_t>(length), 0);
  fifo[0] = 0x80 | 0x74;
  fifo = bench.spi(fifo, 5'000'000);
  const auto accel_x = [&fifo](std::size_t i) { return fifo[1 + 12 * i] << 8 | fifo[2 + 12 * i]; };
  std::vector<std::size_t> changes;
  for (std::size_t i = 1; i < 40; ++i) {
    if (accel_x(i) != accel_x(i - 1)) changes.push_back(i);
  }
  ASSERT_GE(changes.size(), 4u);
  for (std::size_t k = 1; k < changes.size(); ++k) EXPECT_EQ(changes[k] - changes[k - 1], 8u);
  EXPECT_TRUE(bench.findings.empty()) << bench.findings.front();
}

}  // namespace
}  // namespace whirl::io

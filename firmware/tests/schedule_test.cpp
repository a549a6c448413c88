#include "firmware/flight/schedule.hpp"

#include <gtest/gtest.h>

#include <array>

namespace fw::schedule {
namespace {

TEST(Schedule, SetpointsFollowAnAttitudeStepInTheSameTick) {
  for (std::uint32_t tick = 0; tick < 1000; ++tick) {
    if (setpoints(tick)) {
      EXPECT_TRUE(attitude(tick)) << tick;
    }
  }
}

TEST(Schedule, EachEscIsReadEvery50msAndNeverNearAWrite) {
  std::array<int, 4> last{-1, -1, -1, -1};
  std::array<int, 4> reads{};
  for (int tick = 0; tick < 1000; ++tick) {
    const int motor = status_read(static_cast<std::uint32_t>(tick));
    if (motor < 0) continue;
    const auto i = static_cast<unsigned>(motor);
    ++reads[i];
    if (last[i] >= 0) {
      EXPECT_EQ(tick - last[i], 50);
    }
    last[i] = tick;
    const int phase = tick % 20;  // writes take 0.5 ms from phase 0, a read 0.2 ms
    EXPECT_GE(phase, 1);
    EXPECT_LE(phase, 19);
  }
  EXPECT_EQ(reads, (std::array<int, 4>{20, 20, 20, 20}));
}

TEST(Schedule, RatesAreThoseOfTheDesign) {
  int attitudes = 0, positions = 0, writes = 0, asked = 0;
  for (std::uint32_t tick = 0; tick < 1000; ++tick) {
    attitudes += attitude(tick) ? 1 : 0;
    positions += position(tick) ? 1 : 0;
    writes += setpoints(tick) ? 1 : 0;
    asked += sensors(tick) ? 1 : 0;
  }
  EXPECT_EQ(attitudes, 200);
  EXPECT_EQ(positions, 40);
  EXPECT_EQ(writes, 50);
  EXPECT_EQ(asked, 100);
}

TEST(Schedule, TheLogIsSampledAt150HzAsEvenlyAsTicksAllow) {
  std::uint32_t last = 0, samples = 0;
  for (std::uint32_t tick = 0; tick < 1000; ++tick) {
    if (!log(tick)) continue;
    if (samples++ > 0) {
      EXPECT_GE(tick - last, 6u) << tick;
      EXPECT_LE(tick - last, 7u) << tick;
    }
    last = tick;
  }
  EXPECT_EQ(samples, 150u);
}

}  // namespace
}  // namespace fw::schedule

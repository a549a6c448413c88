#include "harness/pacing/pacer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/pacing/tests/told_clock.hpp"

namespace whirl::pacing {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(Pacer, VirtualTimePassesAtThePaceOfTheHostsClock) {
  for (const double pace : {0.5, 1.0, 4.0}) {
    ToldClock clock;
    Pacer pacer(clock, pace);
    const std::int64_t begin_ns = clock.t_ns;
    for (std::int64_t ms = 0; ms <= 8000; ++ms) pacer.wait_for(ms * kMs);
    EXPECT_EQ(clock.t_ns - begin_ns, std::llround(8e9 / pace)) << pace;
    EXPECT_EQ(pacer.lateness().late_steps, 0);
  }
}

TEST(Pacer, ALittleLatenessIsMadeUpByWhatFollows) {
  ToldClock clock;
  Pacer pacer(clock, 1.0);
  const std::int64_t begin_ns = clock.t_ns;
  for (std::int64_t ms = 0; ms <= 1000; ++ms) {
    pacer.wait_for(ms * kMs);
    if (ms == 500) clock.t_ns += 50 * kMs;
  }
  EXPECT_EQ(clock.t_ns - begin_ns, 1000 * kMs);
  EXPECT_EQ(pacer.lateness().worst_ns, 49 * kMs);
  EXPECT_EQ(pacer.lateness().late_steps, 48);  // 49 ms late, 48, ... 2
  EXPECT_EQ(pacer.lateness().slipped_ns, 0);
}

TEST(Pacer, AStallIsGivenUpAndToldNotHurriedThrough) {
  ToldClock clock;
  Pacer pacer(clock, 2.0);
  const std::int64_t begin_ns = clock.t_ns;
  for (std::int64_t ms = 0; ms <= 1000; ++ms) {
    pacer.wait_for(ms * kMs);
    if (ms == 400) clock.t_ns += 3000 * kMs;
  }
  // 500 ms at pace 2, and the stall less the half millisecond to the next step.
  EXPECT_EQ(clock.t_ns - begin_ns, 500 * kMs + 3000 * kMs - kMs / 2);
  EXPECT_EQ(pacer.lateness().slipped_ns, 3000 * kMs - kMs / 2);
  EXPECT_EQ(pacer.lateness().late_steps, 1);
}

TEST(Pacer, TellsTheVirtualTimeOfWhatCameInBetween) {
  ToldClock clock;
  Pacer pacer(clock, 0.25);
  pacer.wait_for(0);
  EXPECT_EQ(pacer.virtual_ns(clock.t_ns), 0);
  EXPECT_EQ(pacer.virtual_ns(clock.t_ns + 6 * kMs), 3 * kMs / 2);
  EXPECT_EQ(pacer.due_ns(kMs), clock.t_ns + 4 * kMs);
}

TEST(Pacer, LateIsWhatItIsToldToBe) {
  ToldClock clock;
  Pacer pacer(clock, 1.0, 200'000);
  for (std::int64_t ms = 0; ms < 10; ++ms) {
    pacer.wait_for(ms * kMs);
    clock.t_ns += kMs + (ms == 4 ? 200'000 : ms == 7 ? 200'001 : 0);
  }
  EXPECT_EQ(pacer.lateness().late_steps, 2);  // 8 and 9; 5 to 7 are 200 us behind, not more
}

}  // namespace
}  // namespace whirl::pacing

#include "harness/metrics/timing.hpp"

#include <cmath>

#include "harness/base/near.hpp"

namespace whirl::metrics {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(Timing, PeriodsAndTheirDeviations) {
  const std::int64_t times[] = {0, kMs, 2 * kMs + 5000, 3 * kMs};
  const auto periods = periods_s(times);
  ASSERT_EQ(periods.size(), 3u);
  const auto worst = distribution(deviations_s(periods, 0.001)).max;
  EXPECT_TRUE(near(worst, 5e-6, round_off(16, 1e-3)));
}

TEST(Timing, NothingHasNoWorst) {
  EXPECT_TRUE(std::isnan(distribution({}).max));
  EXPECT_TRUE(periods_s({}).empty());
}

// data-ready 0, 1, 2 ms; imu task 0.1..0.2 after each; attitude 1.3..1.6; esc 1.9..2.3 with its write
// 2.0..2.1 ms: the write carries the sample of 1 ms although that of 2 ms was there already.
TEST(Timing, LatencyFollowsTheSampleThroughTheTasks) {
  const std::int64_t ready[] = {0, 1 * kMs, 2 * kMs};
  const std::vector<Span> tasks[] = {
      {{100'000, 200'000}, {1'100'000, 1'200'000}, {2'100'000, 2'200'000}},
      {{1'300'000, 1'600'000}},
      {{1'900'000, 2'300'000}}};
  const Span writes[] = {{2'000'000, 2'100'000}};
  const auto trace = trace_latency(ready, tasks, writes);
  ASSERT_EQ(trace.samples.size(), 1u);
  EXPECT_TRUE(near(trace.samples[0].latency_s, 1.1e-3, round_off(4, 1e-3)));
}

// A task that is still running has left nothing yet: its reader used the call before.
TEST(Timing, AnUnfinishedCallHasNotDeliveredYet) {
  const std::int64_t ready[] = {0, 1 * kMs};
  const std::vector<Span> tasks[] = {{{100'000, 200'000}, {1'100'000, 2'500'000}},
                                     {{2'000'000, 2'100'000}}};
  const Span writes[] = {{2'050'000, 2'400'000}};
  EXPECT_TRUE(near(trace_latency(ready, tasks, writes).samples.at(0).latency_s, 2.4e-3,
                   round_off(4, 1e-3)));
}

// A task reads at its entry: what preempts it and finishes before it ends came too late for it.
TEST(Timing, WhatPreemptsATaskCameTooLateForIt) {
  const std::int64_t ready[] = {0, 1 * kMs};
  const std::vector<Span> tasks[] = {{{100'000, 200'000}, {1'050'000, 1'200'000}},
                                     {{1'000'000, 1'500'000}}};
  const Span writes[] = {{1'400'000, 1'600'000}};
  EXPECT_TRUE(near(trace_latency(ready, tasks, writes).samples.at(0).latency_s, 1.6e-3,
                   round_off(4, 1e-3)));
}

TEST(Timing, WritesBeforeTheFirstSampleAreCountedNotGuessed) {
  const std::int64_t ready[] = {5 * kMs};
  const std::vector<Span> tasks[] = {{{5'100'000, 5'200'000}}};
  const Span writes[] = {{1 * kMs, 2 * kMs}, {6 * kMs, 7 * kMs}};
  const auto trace = trace_latency(ready, tasks, writes);
  EXPECT_EQ(trace.untraced, 1u);
  EXPECT_EQ(trace.samples.size(), 1u);
}

}  // namespace
}  // namespace whirl::metrics

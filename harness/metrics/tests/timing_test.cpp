#include "harness/metrics/timing.hpp"

#include <cmath>

#include "base/near.hpp"

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

TEST(Timing, ADistributionIsItsCountMeanEndsAndQuantiles) {
  std::vector<double> values;
  for (int i = 200; i >= 0; --i) values.push_back(i < 100 ? i : i + 3.0);
  const Distribution d = distribution(values);
  EXPECT_EQ(d.count, 201u);
  EXPECT_TRUE(near(d.mean, 100.0 + 3.0 * 101 / 201, round_off(300, 100.0)));
  EXPECT_EQ(d.min, 0.0);
  EXPECT_EQ(d.p50, 103.0);
  EXPECT_TRUE(near(d.p99, 201.0, round_off(8, 200.0)));
  EXPECT_EQ(d.max, 203.0);
  const Distribution none = distribution({});
  EXPECT_EQ(none.count, 0u);
  for (double x : {none.mean, none.min, none.max, none.p50, none.p99}) EXPECT_TRUE(std::isnan(x));
}

TEST(Timing, ADeviationHasNoSign) {
  const double periods[] = {0.5, 2.0};
  EXPECT_EQ(deviations_s(periods, 1.5), (std::vector<double>{1.0, 0.5}));
}

// What happened at the very moment has happened: the sample at a task's entry, the end of the task before
// at the entry of the next one, the entry of the last one at the write.
TEST(Timing, WhatHappensAtOneMomentIsInTimeForEachOther) {
  const std::int64_t ready[] = {0, 1'000};
  const std::vector<Span> tasks[] = {{{0, 500}, {1'000, 2'000}}, {{2'000, 9'000}}};
  const Span writes[] = {{2'000, 3'000}};
  const auto trace = trace_latency(ready, tasks, writes);
  ASSERT_EQ(trace.samples.size(), 1u);
  EXPECT_EQ(trace.samples[0].write_ns, 3'000);
  EXPECT_TRUE(near(trace.samples[0].latency_s, 2e-6, round_off(4, 1e-6)));
  EXPECT_EQ(trace.untraced, 0u);
}

TEST(Timing, AWriteThatNoCallOrNoSampleLedToIsUntraced) {
  const std::int64_t ready[] = {1'000};
  const std::vector<Span> early[] = {{{999, 1'100}}}, never[] = {{}};
  const Span write[] = {{5'000, 6'000}};
  EXPECT_EQ(trace_latency(ready, early, write).untraced, 1u);
  EXPECT_EQ(trace_latency(ready, never, write).untraced, 1u);
  EXPECT_EQ(trace_latency({}, {}, write).untraced, 1u);
  EXPECT_EQ(trace_latency(ready, {}, write).samples.size(), 1u);
}

}  // namespace
}  // namespace whirl::metrics

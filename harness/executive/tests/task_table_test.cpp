#include "harness/executive/task_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/near.hpp"

namespace whirl {
namespace {

// Of the second of three functions: two calls 2 ms apart and a third 4 ms later. The first was called by
// an interrupt that waited 3 us, the second by one that did not wait, the third by none.
TEST(TaskTable, HasARowForEachWatchedFunctionWithWhatItsCallsTook) {
  results::EventLog events;
  events.calls[1] = {{1'000'000, 1'000'300, 100, 3'000, 17, 50},
                     {3'000'000, 3'000'500, 200, 0, 34, 84},
                     {7'000'000, 7'000'900, 400, -1, 67, 151}};
  const auto rows = task_table({"none", "some", "other"}, events);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].name, "none");
  EXPECT_EQ(rows[0].calls, 0u);
  EXPECT_TRUE(std::isnan(rows[0].period_max_s));
  EXPECT_TRUE(std::isnan(rows[0].latency_max_s));
  EXPECT_EQ(rows[2].name, "other");
  EXPECT_EQ(rows[2].calls, 0u);
  const results::TaskRow& some = rows[1];
  const Tolerance tol = round_off(16, 1e-3);
  EXPECT_EQ(some.name, "some");
  EXPECT_EQ(some.calls, 3u);
  EXPECT_TRUE(near(some.period_mean_s, 3e-3, tol));
  EXPECT_TRUE(near(some.period_max_s, 4e-3, tol));
  EXPECT_TRUE(near(some.execution_p50_s, 200e-9, tol));
  EXPECT_TRUE(
      near(some.execution_p99_s, 396e-9, tol));  // 1.98 of the way from the first to the third
  EXPECT_TRUE(near(some.execution_max_s, 400e-9, tol));
  EXPECT_TRUE(near(some.response_p99_s, 892e-9, tol));
  EXPECT_TRUE(near(some.response_max_s, 900e-9, tol));
  EXPECT_TRUE(near(some.latency_max_s, 3e-6, tol));
  EXPECT_TRUE(near(some.execution_min_s, 100e-9, tol));
  EXPECT_EQ(some.execution_min_cycles, 17.0);
  EXPECT_EQ(some.execution_p50_cycles, 34.0);
  EXPECT_TRUE(near(some.execution_p99_cycles, 66.34, tol));
  EXPECT_EQ(some.execution_max_cycles, 67.0);
  EXPECT_EQ(some.response_max_cycles, 151.0);
  events.calls[1].erase(events.calls[1].begin());
  EXPECT_EQ(task_table({"none", "some"}, events)[1].latency_max_s, 0.0);
}

TEST(InterruptTable, TimesThatNoRunHasOverflowNothing) {
  constexpr std::int64_t kEnd = std::numeric_limits<std::int64_t>::max();
  io::Batch batch;
  batch.add(io::Kind::interrupt_latency, 7, -kEnd, io::InterruptLatency{kEnd});
  batch.add(io::Kind::interrupt_latency, 7, kEnd, io::InterruptLatency{-kEnd});
  results::EventLog events;
  ASSERT_TRUE(events.add(batch));
  EXPECT_EQ(interrupt_table(events)[0].latency_mean_s, 0.0);
  EXPECT_GT(interrupt_table(events)[0].latency_max_s, 1.8e10);
}

TEST(InterruptTable, HasARowForEachExceptionWithWhatItsRequestsWaited) {
  io::Batch batch;
  batch.add(io::Kind::interrupt_latency, 34, 1'000'000, io::InterruptLatency{999'000});
  batch.add(io::Kind::interrupt_latency, 34, 2'000'000, io::InterruptLatency{1'997'000});
  batch.add(io::Kind::interrupt_latency, 34, 3'000'000, io::InterruptLatency{2'999'800});
  batch.add(io::Kind::interrupt_latency, 15, 4'000'000, io::InterruptLatency{4'000'000});
  results::EventLog events;
  ASSERT_TRUE(events.add(batch));
  events.statistics = R"({"handlers": {"34": "adc_handler", "15": 3}})";
  const auto rows = interrupt_table(events);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].exception, 15u);
  EXPECT_EQ(rows[0].requests, 1u);
  EXPECT_EQ(rows[0].latency_max_s, 0.0);
  EXPECT_TRUE(near(rows[0].latency_max_at_s, 4e-3, round_off(16, 1e-3)));
  EXPECT_EQ(rows[1].handler, "adc_handler");
  EXPECT_EQ(rows[1].requests, 3u);
  EXPECT_TRUE(near(rows[1].latency_mean_s, 1.4e-6, round_off(16, 1e-6)));
  EXPECT_TRUE(near(rows[1].latency_max_s, 3e-6, round_off(16, 1e-6)));
  EXPECT_TRUE(near(rows[1].latency_max_at_s, 2e-3, round_off(16, 1e-3)));
  for (const char* text : {"", "[]", "{", R"({"handlers": []})"}) {
    events.statistics = text;
    EXPECT_EQ(interrupt_table(events)[1].handler, "") << text;
  }
}

}  // namespace
}  // namespace whirl

// Time, sleep, interrupts and their priorities.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

TEST(Time, TwentyRunsUnderLoadGiveTheSameBytes) {
  const BusyHost load;
  const std::string first = run_for({image("sleeper"), {}}, 200).digest;
  int same = 0;
  for (int i = 0; i < 20; ++i) same += run_for({image("sleeper"), {}}, 200).digest == first ? 1 : 0;
  EXPECT_NE(first, "");
  EXPECT_EQ(same, 20);
}

TEST(Time, WatchingChangesNoMomentOfTheImage) {
  const BoardRun plain = run_for({image("sleeper"), {}}, 350);
  const BoardRun watched = run_for({image("sleeper"), {"irq31_handler", "main"}}, 350);
  ASSERT_EQ(plain.said().size(), 3u);
  EXPECT_EQ(plain.said(), watched.said());
  EXPECT_GT(watched.of(io::Kind::function_call).size(), 2000u);
}

TEST(Time, ATimerWakesTheCoreAtItsExactNanosecond) {
  const BoardRun run = run_for({image("sleeper"), {}}, 50);
  const auto latencies = run.of(io::Kind::interrupt_latency);
  ASSERT_GE(latencies.size(), 499u);
  const std::int64_t phase = latencies[0]->as<io::InterruptLatency>().raised_ns;
  std::int64_t k = 0;
  for (const Message* latency : latencies) {
    EXPECT_EQ(latency->head.port, 16 + 31);
    EXPECT_EQ(latency->as<io::InterruptLatency>().raised_ns, phase + 100'000 * k++);
    EXPECT_EQ(latency->head.t_ns, latency->as<io::InterruptLatency>().raised_ns);  // it slept
  }
}

TEST(Time, SysTickAndCyccntFollowTheSameClockWithoutDrift) {
  const BoardRun run = run_for({image("ticks"), {}}, 100);
  const auto said = run.said();
  ASSERT_GE(said.size(), 99u);
  for (std::size_t i = 1; i < said.size(); ++i) {
    // 168,000 cycles apart, read a few instructions of 8 ns after the wrap each time.
    EXPECT_TRUE(near(static_cast<double>(said[i] - said[0]), 168000.0 * static_cast<double>(i),
                     stated(1.0, "an instruction of 8 ns is 1.3 cycles")));
  }
}

TEST(Sleep, ForEverIsIdleToTheLastNanosecond) {
  const BoardRun run = run_for({image("idle"), {}}, 20);
  const auto busy = run.of(io::Kind::busy_time);
  ASSERT_EQ(busy.size(), 20u);
  EXPECT_GT(busy[0]->as<io::BusyTime>().busy_ns, 0);  // the start-up code
  for (std::size_t i = 1; i < busy.size(); ++i) {
    EXPECT_EQ(busy[i]->as<io::BusyTime>().busy_ns, 0);
  }
}

TEST(Sleep, AnImageThatComputesAlwaysIsBusyAlways) {
  const BoardRun run = run_for({image("busy"), {}}, 5);
  for (const Message* busy : run.of(io::Kind::busy_time)) {
    EXPECT_EQ(busy->as<io::BusyTime>().busy_ns, 1'000'000);
  }
}

TEST(Priority, FourBitsAreStoredAndBasepriMasksByThem) {
  const BoardRun run = run_for({image("priority"), {}}, 1);
  // After reset 0; 0xFF is stored as 0xF0. Masked: 50/50, 50/5F. Passes: 40 under 5F, 4F (= 40)
  // under 50, 50 under 60.
  EXPECT_EQ(run.said(), (std::vector<std::uint32_t>{0x00, 0xF0, 0b00111}));
}

}  // namespace
}  // namespace whirl::board_test

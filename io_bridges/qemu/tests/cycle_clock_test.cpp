// Time by cycles: what an image counts by CYCCNT, against counts by hand from ARM's tables; when
// interrupts come; and that every run is the same.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

BoardSetup by_cycles(const std::string& name, std::vector<std::string> watch = {}) {
  BoardSetup setup{image(name), std::move(watch)};
  setup.more = R"("ns_per_instruction":0)";
  return setup;
}

TEST(CycleClock, StraightCodeLoopsAndMemoryTakeTheCyclesOfArmsTables) {
  const auto said = run_for(by_cycles("cycles1"), 2).said();
  ASSERT_EQ(said.size(), 8u);
  const auto more = [&](std::size_t n) { return said[n] - said[0]; };
  EXPECT_EQ(said[0], 2u);  // the load of CYCCNT itself
  EXPECT_EQ(more(1), 1u);
  EXPECT_EQ(more(2), 100u);
  // NOP, SUBS, taken BNE with a refill of 1.5 (1 to 3 by alignment); the last one is not taken.
  EXPECT_TRUE(near(more(3), 1 + 1000 * (1 + 1 + 2.5) - 1.5, stated(1.0, "a refill's half cycle")));
  EXPECT_TRUE(near(more(4), 1 + 1000 * (2 + 1 + 2.5) - 1.5,
                   stated(2.0, "a refill's half cycle, twice")));  // RAM
  EXPECT_TRUE(
      near(more(5), more(4),
           stated(2.0, "a refill's half cycle, twice")));  // a register of the core's own bus
  EXPECT_TRUE(near(more(6), 5.0, stated(1.0, "folded or not")));  // MOV, CMP, folded ITE, two, NOP
  EXPECT_GE(more(7), 2u + 2u);
  EXPECT_LE(more(7), 2u + 12u);
}

TEST(CycleClock, WhatADivisionCostsDoesNotTouchItsResult) {
  EXPECT_EQ(run_for(by_cycles("cycles8"), 50).said(), std::vector<std::uint32_t>{0});
}

struct Background {
  const char* image;
  double cycles;  // how late a tick may come: the longest instruction, and where it is cut
};

// The period is exact where nothing holds the core up, and a tick waits for the end of one instruction.
TEST(CycleClock, TicksComeWithinOneInstructionOfTheirTime) {
  for (const Background& b : {Background{"cycles2", 3},
                              {"cycles3", 12},
                              {"cycles4", 1},
                              {"cycles5", 12},
                              {"cycles6", 12},
                              {"cycles7", 6}}) {
    const auto said = run_for(by_cycles(b.image), 50).said();
    ASSERT_GT(said.size(), 400u) << b.image;
    std::int64_t sum = 0;
    for (const std::uint32_t period : said) {
      EXPECT_TRUE(
          near(period, 16800.0, stated(b.cycles, "the longest instruction, and where it is cut")))
          << b.image;
      sum += period;
    }
    EXPECT_TRUE(near(static_cast<double>(sum) / static_cast<double>(said.size()), 16800.0,
                     stated(0.1, "no drift over 400")))
        << b.image;
  }
}

TEST(CycleClock, TwentyRunsUnderLoadGiveTheSameBytes) {
  const BusyHost load;
  for (const char* name : {"sleeper", "ticks", "priority", "rtos", "preempted", "calls", "cycles3",
                           "cycles4", "cycles6", "cycles7"}) {
    const std::string first = run_for(by_cycles(name), 20).digest;
    EXPECT_NE(first, "");
    for (int i = 0; i < 20; ++i) EXPECT_EQ(run_for(by_cycles(name), 20).digest, first) << name;
  }
}

TEST(CycleClock, WatchingChangesNoMomentOfTheImageAndCountsEachCallOnce) {
  const BoardRun plain = run_for(by_cycles("sleeper"), 350);
  const BoardRun watched = run_for(by_cycles("sleeper", {"irq31_handler", "main"}), 350);
  ASSERT_EQ(plain.said().size(), 3u);
  EXPECT_EQ(plain.said(), watched.said());
  for (const char* name : {"cycles2", "cycles3", "cycles5", "cycles7"}) {
    const BoardRun run = run_for(by_cycles(name, {"systick_handler"}), 50);
    EXPECT_TRUE(near(static_cast<double>(run.of(io::Kind::function_call).size()),
                     static_cast<double>(run.said().size()) + 1, stated(1, "one is under way")))
        << name;
    EXPECT_EQ(run.said(), run_for(by_cycles(name), 50).said()) << name;
  }
}

// A register's events go by QEMU's clock, in whole nanoseconds. QEMU fills up its budget every 65 us, at
// moments that are none of the guest's: there it may lag no more than elsewhere.
TEST(CycleClock, TheTimeOfEventsIsTheCoresWhereverQemuFillsItsBudget) {
  // What TIME and CYCCNT are rounded by, and a literal's quarter of a cycle twice.
  constexpr double kNanosecond = 21, kHalf_cycle = 62.5, kLiterals = 62.5;
  const auto said = run_for(by_cycles("clocks1"), 60).said();
  ASSERT_EQ(said.size(), 1u);
  EXPECT_LE(said[0], kNanosecond + kHalf_cycle + kLiterals);
}

// The load in which a deadline falls is done at the deadline, and ends up to its own cycles later.
TEST(CycleClock, TheTimeOfEventsLagsByNoMoreThanTheAccessThatADeadlineFallsIn) {
  constexpr double kLoad_and_its_wait = 5 * 125;
  const auto said = run_for(by_cycles("clocks2"), 60).said();
  ASSERT_EQ(said.size(), 1u);
  EXPECT_LE(said[0], kLoad_and_its_wait + 21 + 62.5);
}

// QEMU fills its budget of 16 bits at each of these stores: nothing may be added to it there.
TEST(CycleClock, NoTurnOfALoopTakesLongerForADeadlineThatItSets) {
  const auto said = run_for(by_cycles("turns"), 20).said();
  ASSERT_EQ(said.size(), 1u);
  // The waits for APB, and pairs that no longer overlap where the harness's turn cuts a block in two.
  EXPECT_LE(said[0], 12u);
}

// Each image's calls differ by their NOPs of a cycle each, in SRAM as in flash without wait states.
TEST(CycleClock, CodeThatIsWrittenOverOtherCodeCostsWhatItNowIs) {
  const auto said = run_for(by_cycles("rewritten"), 20).said();
  ASSERT_EQ(said.size(), 8u);
  for (const std::size_t first : {0u, 4u}) {
    for (std::size_t n = 1; n < 4; ++n) {
      EXPECT_EQ(said[first + n - 1] - said[first + n], 10u) << first << ", " << n;
    }
  }
}

TEST(CycleClock, AComputingCoreIsBusyAlways) {
  const BoardRun busy_run = run_for(by_cycles("busy"), 5);
  ASSERT_EQ(busy_run.of(io::Kind::busy_time).size(), 5u);
  for (const Message* busy : busy_run.of(io::Kind::busy_time)) {
    EXPECT_EQ(busy->as<io::BusyTime>().busy_ns, 1'000'000);
  }
}

}  // namespace
}  // namespace whirl::board_test

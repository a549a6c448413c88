// Functions whose length is known by counting their instructions (8 ns each).
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

constexpr std::int64_t kInstruction_ns = 8;
constexpr std::int64_t kCounted_ns = (1 + 2 * 100 + 1) * kInstruction_ns;

struct Call {
  std::int64_t response_ns, execution_ns;
};

std::vector<Call> calls_of(const BoardRun& run, std::uint16_t number) {
  std::vector<Call> calls;
  for (const Message* message : run.of(io::Kind::function_call)) {
    if (message->head.port != number) continue;
    const auto call = message->as<io::FunctionCall>();
    calls.push_back({message->head.t_ns - call.entry_ns, call.execution_ns});
  }
  return calls;
}

const BoardRun& watched() {
  static const BoardRun run =
      run_for({image("calls"), {"counted", "tail", "conditional", "nested", "irq31_handler"}}, 1);
  return run;
}

TEST(Watch, ALeafTakesItsInstructions) {
  const auto calls = calls_of(watched(), 0);
  ASSERT_EQ(calls.size(), 6u);  // directly, by tail, twice nested, by pointer, interrupted
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(calls[i].response_ns, kCounted_ns) << i;
    EXPECT_EQ(calls[i].execution_ns, kCounted_ns) << i;
  }
}

TEST(Watch, ATailCallCountsForTheCaller) {
  const auto calls = calls_of(watched(), 1);
  ASSERT_EQ(calls.size(), 1u);
  EXPECT_EQ(calls[0].response_ns, kCounted_ns + kInstruction_ns);
}

TEST(Watch, AConditionalReturnThatIsNotTakenIsNoReturn) {
  const auto calls = calls_of(watched(), 2);
  ASSERT_EQ(calls.size(), 1u);
  EXPECT_EQ(calls[0].response_ns, 5 * kInstruction_ns);
}

TEST(Watch, ACallerIncludesItsCalls) {
  const auto calls = calls_of(watched(), 3);
  ASSERT_EQ(calls.size(), 1u);
  EXPECT_EQ(calls[0].response_ns, 4 * kInstruction_ns + 2 * kCounted_ns);
}

TEST(Watch, AnInterruptIsResponseTimeButNotExecutionTime) {
  const auto handler = calls_of(watched(), 4);
  const auto calls = calls_of(watched(), 0);
  ASSERT_EQ(handler.size(), 1u);
  ASSERT_EQ(calls.size(), 6u);
  EXPECT_EQ(calls[5].execution_ns, kCounted_ns);
  EXPECT_EQ(calls[5].response_ns, kCounted_ns + handler[0].execution_ns);
  EXPECT_GT(handler[0].execution_ns, 0);
}

TEST(Watch, AnInterruptDuringWorkIsTakenWithinOneInstruction) {
  const auto latencies = watched().of(io::Kind::interrupt_latency);
  ASSERT_EQ(latencies.size(), 1u);
  const std::int64_t latency_ns =
      latencies[0]->head.t_ns - latencies[0]->as<io::InterruptLatency>().raised_ns;
  EXPECT_GE(latency_ns, 0);
  EXPECT_LE(latency_ns, kInstruction_ns);
}

// The request waits from 800 ns after the store to the end of the 202 instructions that follow it.
TEST(Watch, ARequestThatIsHeldOffWaitsAsLongAsTheLock) {
  const BoardRun run = run_for({image("held"), {"irq31_handler", "hold"}}, 1);
  const auto calls = run.of(io::Kind::function_call);
  ASSERT_EQ(calls.size(), 2u);
  for (const Message* message : calls) {
    const auto call = message->as<io::FunctionCall>();
    if (message->head.port == 1) {
      EXPECT_EQ(call.latency_ns, -1);  // called by main
      continue;
    }
    const double held_ns = static_cast<double>(202 * kInstruction_ns - 800);
    EXPECT_TRUE(near(static_cast<double>(call.latency_ns), held_ns,
                     stated(kInstruction_ns, "one instruction")));
  }
}

}  // namespace
}  // namespace whirl::board_test

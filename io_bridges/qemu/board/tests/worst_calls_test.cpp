// Which call is the longest, and what came while it was open.
#include "io_bridges/qemu/board/worst_calls.hpp"

#include <gtest/gtest.h>

namespace whirl::board {
namespace {

LongCall call(Nanoseconds entry_ns, Nanoseconds execution_ns, Nanoseconds response_ns) {
  LongCall one;
  one.entry_ns = entry_ns;
  one.return_ns = entry_ns + response_ns;
  one.execution = {execution_ns, static_cast<std::uint64_t>(execution_ns) / 8};
  one.response = {response_ns, static_cast<std::uint64_t>(response_ns) / 8};
  return one;
}

TEST(WorstCalls, TheFirstLongestIsKeptByExecutionAndByResponse) {
  WorstCalls calls;
  int asked = 0;
  const auto path = [&asked] { return "path " + std::to_string(++asked); };
  calls.returned(3, call(0, 80, 100), 0, path);
  calls.returned(3, call(1000, 80, 100), 0, path);  // no longer
  calls.returned(3, call(2000, 40, 400), 0, path);
  calls.returned(3, call(3000, 90, 90), 0, path);
  calls.returned(3, call(4000, 1, 1), 0, path);
  EXPECT_EQ(asked, 3);
  ASSERT_EQ(calls.by_number().size(), 1u);
  const WorstCalls::Pair& worst = calls.by_number().at(3);
  EXPECT_EQ(worst.execution.entry_ns, 3000);
  EXPECT_EQ(worst.execution.path, "path 3");
  EXPECT_EQ(worst.response.entry_ns, 2000);
  EXPECT_EQ(worst.response.path, "path 2");
  EXPECT_EQ(worst.response.response.cycles, 50u);
}

TEST(WorstCalls, OnlyExceptionsTakenWithinTheCallAreBetween) {
  WorstCalls calls;
  calls.exception_ended(20, 50, {7, 1});  // before it
  const std::uint64_t before = calls.exceptions();
  calls.exception_ended(21, 120, {8, 1});
  calls.exception_ended(40, 90, {9, 1});  // the call was made in it, or it was active at its entry
  calls.exception_ended(21, 150, {16, 2});
  calls.exception_ended(5, 160, {1, 1});
  calls.returned(0, call(100, 50, 100), before, {});
  const LongCall& longest = calls.by_number().at(0).response;
  ASSERT_EQ(longest.between.size(), 2u);
  EXPECT_EQ(longest.exceptions, 4u);
  EXPECT_EQ(longest.between[0].exception, 5u);
  EXPECT_EQ(longest.between[1].exception, 21u);
  EXPECT_EQ(longest.between[1].times, 2u);
  EXPECT_EQ(longest.between[1].ran.ns, 24);
  EXPECT_EQ(longest.between[1].ran.cycles, 3u);
}

TEST(WorstCalls, OfManyExceptionsTheLastOnesAreListedAndAllAreCounted) {
  WorstCalls calls;
  for (int n = 0; n < 100; ++n) calls.exception_ended(15, 200 + n, {1, 1});
  calls.returned(0, call(100, 50, 1000), 0, {});
  const LongCall& longest = calls.by_number().at(0).response;
  EXPECT_EQ(longest.exceptions, 100u);
  ASSERT_EQ(longest.between.size(), 1u);
  EXPECT_EQ(longest.between[0].times, 64u);
}

}  // namespace
}  // namespace whirl::board

// Budgets of a function's share of time and of its rate beside a sensor's: which calls they count.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "harness/tests/oracle/by_hand.hpp"

namespace whirl::oracle {
namespace {

constexpr const char* kShare = "t:budget 'fw::task' { share = '50 %', during = '20 ms' }";
constexpr const char* kRate =
    "t:budget 'fw::task' { rate = '10 %', of = 'imu', every = 2, during = '20 ms' }";

Scenario budget(const std::string& lua) {
  return with_two_signals(lua + " t:wait '30 ms'");
}

void call(Scenario& s, std::int64_t entry_ns, std::int64_t return_ns, std::int64_t execution_ns) {
  s.messages.push_back({return_ns, [=](io::Batch& batch) {
                          batch.add(io::Kind::function_call, 1, return_ns,
                                    io::FunctionCall{entry_ns, execution_ns, -1});
                        }});
}

TEST(Shares, AreOfTheCallsThatBeganAndEndedInTheWindow) {
  Scenario s = budget(kShare);
  call(s, 2 * kMs, 5 * kMs, 1 * kMs);
  call(s, 6 * kMs, 10 * kMs, 3 * kMs);
  call(s, 19 * kMs, 21 * kMs, 2 * kMs);  // cut by its end
  call(s, 22 * kMs, 23 * kMs, 1 * kMs);  // behind it
  const results::Expectation e = only(s);
  EXPECT_EQ(e.name, "fw::task share of time");
  EXPECT_TRUE(near(e.measured, 20.0, round_off(8, 100)));
  EXPECT_EQ(e.note, "2 calls");
  EXPECT_EQ(e.verdict, results::Verdict::pass);
}

TEST(Shares, OfAFunctionThatNeverRanAreNoPass) {
  Scenario s = budget(kShare);
  EXPECT_TRUE(std::isnan(only(s).measured));
  EXPECT_EQ(only(s).verdict, results::Verdict::fail);
}

// Each 2 ms the sensor's data, each 4 ms the call; one that the window cuts is none.
TEST(Shares, ARateIsThatOfWholeCallsBesideTheSensorsOwn) {
  Scenario s = budget(kRate);
  for (std::int64_t t = 1; t < 20; t += 2) {
    s.messages.push_back(
        {t * kMs, [t](io::Batch& b) { b.add(io::Kind::data_ready, 0, t * kMs, nullptr, 0); }});
    if (t % 4 == 1) call(s, t * kMs, (t + 1) * kMs, kMs / 2);
  }
  call(s, 20 * kMs - 1, 21 * kMs, kMs / 2);
  const results::Expectation e = only(s);
  EXPECT_EQ(e.name, "fw::task rate error");
  EXPECT_TRUE(near(e.measured, 0.0, round_off(8, 100)));
  EXPECT_EQ(e.note, "every 4 ms, the sensor's own 4 ms");
  EXPECT_EQ(e.verdict, results::Verdict::pass);
}

}  // namespace
}  // namespace whirl::oracle

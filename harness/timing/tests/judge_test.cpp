// How far a kernel is outside of its range, and what the score makes of it.
#include "harness/timing/judge.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"

namespace whirl::timing {
namespace {

Expectation between(const std::string& kernel, double low, double high) {
  Expectation e;
  e.kernel = kernel;
  e.low_cycles = low;
  e.high_cycles = high;
  return e;
}

Report measured(std::vector<Row> rows) {
  return {"stm32f405", std::move(rows), true};
}

TEST(TimingJudge, InsideTheRangeThereIsNoError) {
  const Expectation branch = between("branch", 2.0, 4.0);
  for (double cycles : {2.0, 3.1, 4.0}) EXPECT_EQ(error_of(cycles, branch), 0.0) << cycles;
}

TEST(TimingJudge, OutsideItIsTheDistanceFromTheNearerEnd) {
  const Expectation branch = between("branch", 2.0, 4.0);
  EXPECT_TRUE(near(error_of(5.0, branch), 0.25, round_off(4, 1.0)));
  EXPECT_TRUE(near(error_of(1.0, branch), -0.5, round_off(4, 1.0)));
}

// 1000 iterations, so that each row is one thousandth beside a limit.
TEST(TimingJudge, TenAndFifteenPercentDivideTheGrades) {
  const std::vector<Expectation> table = {between("k", 1.0, 1.0)};
  const std::pair<std::uint32_t, Grade> rows[] = {
      {1000, Grade::within}, {1099, Grade::within}, {1101, Grade::outer}, {1149, Grade::outer},
      {1151, Grade::beyond}, {901, Grade::within},  {899, Grade::outer},  {851, Grade::outer},
      {849, Grade::beyond},  {0, Grade::beyond}};
  for (const auto& [cycles, grade] : rows) {
    EXPECT_EQ(judge(table, measured({{"k", 1000, cycles}}))[0].grade, grade) << cycles;
  }
}

TEST(TimingJudge, AMissingKernelFailsByName) {
  const auto verdicts =
      judge({between("add", 1.0, 1.0), between("mul", 1.0, 1.0)}, measured({{"add", 10, 10}}));
  ASSERT_EQ(verdicts.size(), 2u);
  EXPECT_EQ(verdicts[1].expected.kernel, "mul");
  EXPECT_EQ(verdicts[1].grade, Grade::missing);
  const Score score = score_of(verdicts);
  EXPECT_EQ(score.within, 1);
  EXPECT_EQ(score.judged, 2);
  EXPECT_EQ(score.missing, 1);
}

TEST(TimingJudge, AKernelOfNoTableFailsToo) {
  const auto verdicts =
      judge({between("add", 1.0, 1.0)}, measured({{"add", 10, 10}, {"sub", 10, 10}}));
  ASSERT_EQ(verdicts.size(), 2u);
  EXPECT_EQ(verdicts[1].expected.kernel, "sub");
  EXPECT_EQ(verdicts[1].grade, Grade::unknown);
  const Score score = score_of(verdicts);
  EXPECT_EQ(score.within, 1);
  EXPECT_EQ(score.judged, 2);
  EXPECT_EQ(score.unknown, 1);
}

TEST(TimingJudge, WithoutARangeItIsOnlyReportedButMustCome) {
  Expectation open = between("empty", 0.0, 0.0);
  open.judged = false;
  const auto there = judge({open}, measured({{"empty", 1, 0}}));
  EXPECT_EQ(there[0].grade, Grade::reported);
  EXPECT_EQ(score_of(there).judged, 0);
  const auto gone = judge({open}, measured({}));
  EXPECT_EQ(gone[0].grade, Grade::missing);
  EXPECT_EQ(score_of(gone).judged, 1);
  EXPECT_EQ(score_of(gone).within, 0);
}

TEST(TimingJudge, TheMeanErrorIsOfWhatWasExpectedAndReported) {
  const auto verdicts =
      judge({between("a", 1.0, 1.0), between("b", 1.0, 1.0), between("c", 1.0, 1.0)},
            measured({{"a", 100, 120}, {"b", 100, 90}, {"d", 1, 900}}));
  const Score score = score_of(verdicts);
  EXPECT_TRUE(near(score.mean_error, 0.15, round_off(8, 1.0)));
  EXPECT_EQ(score.within, 1);
  EXPECT_EQ(score.outer, 0);
  EXPECT_EQ(score.judged, 4);
}

}  // namespace
}  // namespace whirl::timing

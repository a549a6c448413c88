#include "plant/validation/blade_score.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"

namespace whirl::plant {
namespace {

constexpr Limits kLimits{7.5, 8.0, 12.0, 14.0, 10.0, 12.0, 15.0, 3.0};

std::vector<Bound> summary(const std::vector<Score>& scores, const Limits& asked) {
  Report report;
  add_summary("x", scores, kLimits, asked, report);
  return report.figures;
}

const std::vector<Score> kTen(10, Score{7.0, 5.0, 0.95, 0.85, 10.0, 11.0, false});

TEST(BladeScore, WhatIsAskedAndNotReachedSaysSoAndKeepsItsOwnLimit) {
  const auto figures = summary(kTen, kAsked);
  ASSERT_EQ(figures.size(), 10u);
  EXPECT_EQ(figures[0].name, "x: flight CT, median (asked 6: not reached)");
  EXPECT_EQ(figures[0].limit, 7.5);
  EXPECT_EQ(figures[1].name, "x: flight CP, median");
  EXPECT_EQ(figures[4].name, "x: CT outside the 90 % band");
  EXPECT_TRUE(near(figures[4].value, 5.0, round_off(64, 100.0)));
  EXPECT_EQ(figures[5].name, "x: CP outside the 90 % band (asked 10: not reached)");
  EXPECT_EQ(figures[9].value, 7.0);
  EXPECT_EQ(figures[9].unit, "of 9");
}

TEST(BladeScore, WhereNothingIsAskedNothingIsCounted) {
  EXPECT_EQ(summary(kTen, kNothing).size(), 9u);
}

TEST(BladeScore, ARefusedOneIsMissedByNineInTenAndHasNoPartInTheMedian) {
  auto scores = kTen;
  scores[0] = scores[1] = Score{.refused = true};
  const auto figures = summary(scores, kAsked);
  EXPECT_EQ(figures[0].value, 7.0);
  EXPECT_EQ(figures[2].value, kUnjudged);
  EXPECT_EQ(figures[8].value, 2.0);
}

}  // namespace
}  // namespace whirl::plant

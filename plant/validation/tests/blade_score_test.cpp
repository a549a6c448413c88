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

// Two runs of one slope, the faster one lower as a whole: the step between them is not the slope's.
TEST(BladeScore, SlopeOverJIsThatWithinEachRun) {
  std::vector<MeasuredPoint> points;
  for (const double omega : {400.0, 600.0}) {
    const double first_J = omega == 400.0 ? 0.1 : 0.4;
    for (int k = 0; k < 4; ++k) {
      const double J = first_J + 0.1 * k;
      points.push_back({omega, J, 0.1, 0.05 - 0.04 * J - (omega == 400.0 ? 0.0 : 0.01)});
    }
  }
  const auto all = slope_over_J(points, &MeasuredPoint::CP, kUnjudged);
  ASSERT_TRUE(all.has_value());
  EXPECT_TRUE(near(*all, -0.04, round_off(64, 1.0)));
  points[3].CP += 0.01;  // of J 0.4: beyond
  EXPECT_TRUE(near(slope_over_J(points, &MeasuredPoint::CP, 0.35).value_or(0.0), -0.04,
                   round_off(64, 1.0)));
  EXPECT_FALSE(slope_over_J(points, &MeasuredPoint::CP, 0.15).has_value());  // one point
}

TEST(BladeScore, SlopesAreToldInTheMedianOfThoseThatHaveOne) {
  auto scores = kTen;
  for (std::size_t i = 0; i < 3; ++i) scores[i].slope_CP = 10.0 * static_cast<double>(i + 1);
  scores[0].low_slope_CP = 2.5;
  scores[1].refused = true;
  Report report;
  add_slopes("x", scores, report);
  ASSERT_EQ(report.figures.size(), 2u);
  EXPECT_EQ(report.figures[0].name, "x: slope of CP over J off by, median of 2");
  EXPECT_TRUE(near(report.figures[0].value, 20.0, round_off(8, 20.0)));
  EXPECT_EQ(report.figures[0].limit, kUnjudged);
  EXPECT_EQ(report.figures[1].value, 2.5);
}

}  // namespace
}  // namespace whirl::plant

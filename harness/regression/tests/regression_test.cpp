// Oracle: data made from known constants and known noise; textbook values of Student's t.
#include "harness/regression/regression.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "base/random.hpp"

namespace whirl::regression {
namespace {

constexpr double kSlope = 3.0e-5, kOffset = 0.4, kNoise = 0.02;

Problem line(std::uint64_t seed, int points) {
  RandomStream noise(seed, "regression_test");
  Problem p{"line", "y", "V", {}, {{"offset", "V", {}}, {"slope", "V s", {}}}};
  for (int i = 0; i < points; ++i) {
    const double x = 1e4 * (1.0 + 0.2 * i);
    p.y.push_back(kOffset + kSlope * x + kNoise * noise.normal());
    p.columns[0].x.push_back(1.0);
    p.columns[1].x.push_back(x);
  }
  return p;
}

TEST(Regression, FindsExactDataExactlyWhateverTheUnits) {
  Problem p = line(1, 6);
  for (std::size_t i = 0; i < p.y.size(); ++i) p.y[i] = kOffset + kSlope * p.columns[1].x[i];
  const auto fit = solve(p);
  ASSERT_TRUE(fit.ok());
  EXPECT_TRUE(
      near(fit.value().value("slope"), kSlope, stated(1e-12 * kSlope, "round-off, scaled")));
  EXPECT_TRUE(near(fit.value().value("offset"), kOffset, stated(1e-12, "round-off, scaled")));
  EXPECT_TRUE(near(fit.value().r2, 1.0, stated(1e-12, "round-off")));
}

TEST(Regression, IntervalsCoverTheTruthInNinetyFivePercentOfSeeds) {
  constexpr int kSeeds = 2000;
  int slope = 0, offset = 0, ratio = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const auto found = solve(line(static_cast<std::uint64_t>(seed), 8));
    ASSERT_TRUE(found.ok());
    const Fit& fit = found.value();
    const Coefficient over = quotient(fit, "offset", "slope", "ratio", "");
    slope += std::abs(fit["slope"].value - kSlope) <= fit["slope"].half_width ? 1 : 0;
    offset += std::abs(fit["offset"].value - kOffset) <= fit["offset"].half_width ? 1 : 0;
    ratio += std::abs(over.value - kOffset / kSlope) <= over.half_width ? 1 : 0;
  }
  // Four standard deviations of a count with p = 0.95: 39. The quotient holds to first order only.
  EXPECT_TRUE(near(slope, 1900, stated(39, "four standard deviations")));
  EXPECT_TRUE(near(offset, 1900, stated(39, "four standard deviations")));
  EXPECT_TRUE(near(ratio, 1900, stated(60, "and the first order")));
}

TEST(Regression, CorrelatedResidualsWidenTheIntervals) {
  constexpr int kSeeds = 300, kPoints = 400;
  int covered = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    RandomStream noise(static_cast<std::uint64_t>(seed), "correlated");
    Problem p{"mean", "y", "", {}, {{"mean", "", {}}}, {}, true};
    double drift = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      drift = 0.8 * drift + noise.normal();
      p.y.push_back(1.0 + drift);
      p.columns[0].x.push_back(1.0);
    }
    const auto fit = solve(p);
    ASSERT_TRUE(fit.ok());
    covered += std::abs(fit.value().value("mean") - 1.0) <= fit.value()["mean"].half_width ? 1 : 0;
  }
  EXPECT_TRUE(
      near(covered, 285,
           stated(18, "nearly five standard deviations")));  // without the widening: about 165
}

TEST(Regression, WeightsCountPointsByTheirWorth) {
  Problem p = line(3, 6);
  p.y[5] += 5.0;  // a point that nobody should believe
  p.weights.assign(6, 1.0);
  p.weights[5] = 1e-6;
  const auto fit = solve(p);
  ASSERT_TRUE(fit.ok());
  EXPECT_TRUE(near(fit.value().value("slope"), kSlope,
                   stated(0.15 * kSlope, "one seed; the slope's standard deviation is 11 %")));
}

TEST(Regression, RefusesWhatTheDataCannotTellApartByName) {
  Problem p = line(1, 6);
  p.columns[1].x.assign(6, 1e4);  // all at one speed
  const auto fit = solve(p);
  ASSERT_FALSE(fit.ok());
  EXPECT_EQ(fit.error().kind, ErrorKind::bad_input);
  EXPECT_NE(fit.error().what.find("offset and slope"), std::string::npos) << fit.error().what;
}

TEST(Regression, RefusesAColumnOfZerosTooFewPointsAndNaN) {
  Problem zeros = line(1, 6);
  zeros.columns[1].x.assign(6, 0.0);
  EXPECT_FALSE(solve(zeros).ok());
  EXPECT_FALSE(solve(line(1, 3)).ok());
  Problem nan = line(1, 6);
  nan.y[2] = std::nan("");
  EXPECT_FALSE(solve(nan).ok());
}

TEST(Regression, RefusesWhatOverflowsOnTheWay) {
  for (const double huge : {1e160, 1e308}) {
    Problem columns = line(1, 6);
    for (double& x : columns.columns[1].x) x *= huge;
    EXPECT_FALSE(solve(columns).ok()) << huge;
    Problem weights = line(1, 6);
    weights.weights.assign(weights.y.size(), 1e308);
    weights.y[0] = huge;
    EXPECT_FALSE(solve(weights).ok()) << huge;
  }
}

TEST(Regression, StudentsTIsTheTextbooks) {
  EXPECT_TRUE(near(student_t95(1), 12.706, printed_to(1e-3)));
  EXPECT_TRUE(near(student_t95(2), 4.303, printed_to(1e-3)));
  EXPECT_TRUE(near(student_t95(3), 3.182, printed_to(1e-3)));
  EXPECT_TRUE(near(student_t95(6), 2.447, stated(2e-3, "the expansion's 0.1 %")));
  EXPECT_TRUE(near(student_t95(30), 2.042, stated(2e-3, "the expansion's 0.1 %")));
}

}  // namespace
}  // namespace whirl::regression

#include "plant/parts/spread.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "base/near.hpp"
#include "plant/parts/esc_stand.hpp"

namespace whirl::plant {
namespace {

struct Moments {
  double mean = 0.0, sigma = 0.0, least = 1e9, most = -1e9;
};

Moments moments(const Spread& spread, ToleranceClass tolerance) {
  constexpr int kCopies = 4000;
  double sum = 0.0, squares = 0.0;
  Moments m;
  for (int seed = 1; seed <= kCopies; ++seed) {
    const double x = draw(spread, tolerance, static_cast<std::uint64_t>(seed), "part");
    sum += x, squares += x * x;
    m.least = std::min(m.least, x), m.most = std::max(m.most, x);
  }
  m.mean = sum / kCopies;
  m.sigma = std::sqrt(squares / kCopies - m.mean * m.mean);
  return m;
}

TEST(Spread, NormalPartsScatterBySigmaAndNoneIsBeyondTheLimit) {
  const Moments m = moments({Spread::Law::normal, 10.0, 1.0, 2.0}, ToleranceClass::typical);
  EXPECT_TRUE(near(m.mean, 10.0, stated(0.05, "three standard errors of 4000")));
  // A normal law cut at two sigma keeps 0.880 of its sigma: sqrt(1 - 4 phi(2) / (2 Phi(2) - 1)).
  EXPECT_TRUE(near(m.sigma, 0.880, stated(0.03, "three standard errors")));
  EXPECT_GE(m.least, 8.0);
  EXPECT_LE(m.most, 12.0);
}

TEST(Spread, EvenPartsFillTheirTolerance) {
  const Moments m = moments({Spread::Law::even, 0.0, 0.0, 0.01}, ToleranceClass::typical);
  EXPECT_TRUE(near(m.sigma, 0.01 / std::sqrt(3.0), stated(2e-4, "three standard errors")));
  EXPECT_LT(m.most, 0.01);
  EXPECT_GT(m.least, -0.01);
  EXPECT_GT(m.most - m.least, 0.0198);
}

TEST(Spread, WorstPartsStandAtTheirLimitsOnBothSides) {
  std::set<double> seen;
  for (std::uint64_t seed = 1; seed < 40; ++seed) {
    seen.insert(draw({Spread::Law::normal, 1.0, 0.1, 0.25}, ToleranceClass::worst, seed, "part"));
  }
  EXPECT_EQ(seen, (std::set<double>{0.75, 1.25}));
  EXPECT_EQ(draw({Spread::Law::level, 1.0, 0.5, 3.0}, ToleranceClass::worst, 7, "noise"), 4.0);
}

TEST(Spread, EachNumberHasItsOwnStream) {
  const Spread spread{Spread::Law::even, 0.0, 0.0, 1.0};
  const auto of = [&](const char* stream, std::uint64_t seed) {
    return draw(spread, ToleranceClass::typical, seed, stream);
  };
  EXPECT_EQ(of("a", 1), of("a", 1));
  EXPECT_NE(of("a", 1), of("b", 1));
  EXPECT_NE(of("a", 1), of("a", 2));
}

TEST(EscStandParts, AreNamedOnceAndInAGroupThatCanBeChosen) {
  std::set<std::string> names, groups;
  for (const char* group : esc_stand_groups()) groups.insert(group);
  for (const PartNumber& part : esc_stand_numbers()) {
    EXPECT_TRUE(names.insert(part.name).second) << part.name;
    EXPECT_EQ(groups.count(part.group), 1u) << part.name;
    EXPECT_GT(std::string(part.source).size(), 3u) << part.name;
    EXPECT_TRUE(part.spread.law != Spread::Law::normal || part.spread.limit >= part.spread.sigma);
  }
}

// Two resistors of 1 % that are off the opposite ways: 10 k and 1.5 k give up to 1.75 %.
TEST(EscStandParts, DividerIsOffByItsLowerResistorsShareOfTheDifference) {
  const double off = (1.5 * 1.01) / (1.5 * 1.01 + 10.0 * 0.99) * 11.5 / 1.5 - 1.0;
  EXPECT_TRUE(near(divider_error(-0.01, 0.01), off, round_off(8, 1.0)));
  EXPECT_TRUE(near(off, 0.0175, printed_to(0.0001)));
  EXPECT_TRUE(near(divider_error(0.01, 0.01), 0.0, round_off(8, 1.0)));
}

TEST(Spread, EveryDrawLiesWithinItsBoundsAndComesNearThem) {
  for (const Spread::Law law : {Spread::Law::normal, Spread::Law::even, Spread::Law::level}) {
    for (const auto tolerance : {ToleranceClass::typical, ToleranceClass::worst}) {
      const Spread spread{law, 10.0, 1.0, 2.0};
      const Moments m = moments(spread, tolerance);
      const DrawRange b = bounds(spread, tolerance);
      EXPECT_GE(m.least, b.low);
      EXPECT_LE(m.most, b.high);
      EXPECT_TRUE(
          near(m.least, b.low, stated(0.01, "of 4000 draws the last hundredth holds some")));
      EXPECT_TRUE(near(m.most, b.high, stated(0.01, "the same")));
    }
  }
}

}  // namespace
}  // namespace whirl::plant

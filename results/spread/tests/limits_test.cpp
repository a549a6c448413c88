#include "results/spread/limits.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace whirl::results {
namespace {

Expectation judged(const std::string& place, const std::string& how, double value,
                   std::optional<double> low, std::optional<double> high) {
  Expectation e;
  e.name = "of " + place, e.place = place, e.how = how, e.unit = "ms";
  e.measured = value, e.low = low, e.high = high;
  return e;
}

struct Runs {
  std::vector<SeedRun> runs;
  void add(std::uint64_t seed, std::vector<Expectation> expectations) {
    runs.emplace_back().report.seed = seed;
    runs.back().report.expectations = std::move(expectations);
  }
  std::vector<ProposedLimit> proposed() const {
    std::vector<const SeedRun*> all;
    all.reserve(runs.size());
    for (const SeedRun& run : runs) all.push_back(&run);
    return propose_limits(all, 0.3);
  }
};

TEST(Limits, AreTheWorstAndItsMarginRoundedOutwards) {
  Runs r;
  r.add(1, {judged("a:1", "at most", 0.061, {}, 5.0), judged("a:2", "at least", 37.1, 2.0, {})});
  r.add(7, {judged("a:1", "at most", 0.072, {}, 5.0), judged("a:2", "at least", 41.0, 2.0, {})});
  const auto limits = r.proposed();
  ASSERT_EQ(limits.size(), 2U);
  EXPECT_EQ(limits[0].highest_seed, 7U);
  EXPECT_TRUE(near(*limits[0].high_proposed, 0.094, stated(1e-12, "round-off")));  // 0.0936
  EXPECT_TRUE(near(*limits[1].low_proposed, 25.0, stated(1e-12, "round-off")));    // 25.97
}

TEST(Limits, BelowZeroMoveAwayFromWhatWasMeasured) {
  Runs r;
  r.add(1, {judged("a:1", "at most", -10.0, {}, 0.0), judged("a:2", "at least", -10.0, -50.0, {})});
  r.add(2, {judged("a:1", "at most", -12.0, {}, 0.0), judged("a:2", "at least", -12.0, -50.0, {})});
  const auto limits = r.proposed();
  EXPECT_TRUE(near(*limits[0].high_proposed, -7.0, stated(1e-12, "round-off")));
  EXPECT_TRUE(near(*limits[1].low_proposed, -16.0, stated(1e-12, "round-off")));  // -15.6
}

TEST(Limits, OfARangeBothSidesMoveByTheSpread) {
  Runs r;
  r.add(1, {judged("a:1", "within", 1.0, 0.0, 9.0)});
  r.add(2, {judged("a:1", "within", 1.1, 0.0, 9.0)});
  const auto limits = r.proposed();
  ASSERT_EQ(limits.size(), 1U);
  // Three sigma of two that differ by 0.1 are 0.212, and 30 % of them 0.064.
  EXPECT_TRUE(near(*limits[0].low_proposed, 0.93, stated(1e-12, "round-off")));
  EXPECT_TRUE(near(*limits[0].high_proposed, 1.17, stated(1e-12, "round-off")));
}

TEST(Limits, ALineInALoopIsOneLimit) {
  Runs r;
  auto roll = judged("a:1", "at most", 90.0, {}, 100.0), pitch = roll;
  roll.name = "roll", pitch.name = "pitch", pitch.measured = 93.0;
  r.add(1, {roll, pitch});
  r.add(2, {roll, roll});
  const auto limits = r.proposed();
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_EQ(limits[0].judged, 2U);
  EXPECT_EQ(limits[0].name, "pitch");
  EXPECT_NE(limits_text(limits, 0.3).find("now at most 100 ms; proposed at most 130 ms"),
            std::string::npos)
      << limits_text(limits, 0.3);
}

TEST(Limits, NothingFollowsFromWhatIsNoMeasure) {
  Runs r;
  r.add(1, {judged("a:1", "holds", std::nan(""), {}, {}), judged("a:2", "at most", 0.0, {}, 3.0),
            judged("a:3", "at most", 1.0, {}, 3.0), judged("a:4", "equal", 1.0, 1.0, 1.0)});
  r.add(2,
        {judged("a:1", "holds", std::nan(""), {}, {}), judged("a:2", "at most", 0.0, {}, 3.0),
         judged("a:3", "at most", std::nan(""), {}, 3.0), judged("a:4", "equal", 1.0, 1.0, 1.0)});
  EXPECT_TRUE(r.proposed().empty());
}

}  // namespace
}  // namespace whirl::results

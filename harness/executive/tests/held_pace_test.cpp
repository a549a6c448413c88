#include "harness/executive/held_pace.hpp"

#include <gtest/gtest.h>

namespace whirl {
namespace {

HeldPace held(std::int64_t late, std::int64_t slipped_ns = 0) {
  HeldPace pace;
  pace.late_ns = 200'000;
  pace.late_share = 0.01;
  pace.lateness_s.assign(1000, 1e-5);
  pace.late_steps = late;
  pace.slipped_ns = slipped_ns;
  return pace;
}

results::Report told(const HeldPace* pace) {
  results::Report report;
  report_pace(pace, 1.0, report);
  return report;
}

TEST(HeldPace, AHostOnTimeLeavesTheVerdictAlone) {
  const HeldPace pace = held(10);  // one in a hundred, as allowed
  const results::Report report = told(&pace);
  EXPECT_TRUE(report.untimely.empty());
  ASSERT_EQ(report.histograms.size(), 1u);
  EXPECT_EQ(report.histograms[0].samples.size(), 1000u);
  EXPECT_EQ(report.histograms[0].limit, 2e-4);
}

TEST(HeldPace, OneStepMoreOrAnyStallTakesItAway) {
  for (const HeldPace& pace : {held(11), held(0, 1)}) {
    EXPECT_NE(told(&pace).untimely.find("the host was late"), std::string::npos);
  }
}

TEST(HeldPace, ATargetThatWaitsHasNothingToTell) {
  EXPECT_TRUE(told(nullptr).histograms.empty());
  const HeldPace none;
  EXPECT_TRUE(told(&none).histograms.empty());
}

}  // namespace
}  // namespace whirl

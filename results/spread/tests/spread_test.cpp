#include "results/spread/spread.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "base/whole_file.hpp"
#include "results/messages/message_file.hpp"
#include "results/spread/file_spread.hpp"
#include "results/spread/overlay.hpp"
#include "results/tests/sample.hpp"

namespace whirl::results {
namespace {

Expectation measured(const std::string& name, double value, double limit) {
  Expectation e;
  e.name = name;
  e.how = "at most";
  e.measured = value;
  e.high = limit;
  e.unit = "cm";
  e.margin = limit - value;
  e.verdict = value <= limit ? Verdict::pass : Verdict::fail;
  return e;
}

SeedRun run_on(std::uint64_t seed, const std::vector<double>& heights_cm) {
  SeedRun run;
  run.report.plan = "hover";
  run.report.digest = "1";
  run.report.seed = seed;
  for (const double height_cm : heights_cm) {
    run.report.expectations.push_back(measured("height", height_cm, 5.0));
  }
  conclude(run.report);
  return run;
}

std::vector<const SeedRun*> all(const std::vector<SeedRun>& runs) {
  std::vector<const SeedRun*> out;
  out.reserve(runs.size());
  for (const SeedRun& run : runs) out.push_back(&run);
  return out;
}

TEST(Spread, IsMeanSigmaAndWhoWasWorst) {
  const std::vector<SeedRun> runs{run_on(9, {6.0, 1.0}), run_on(3, {3.0, 1.0}), run_on(4, {4.5})};
  const Spread spread = spread_of(all(runs));
  EXPECT_EQ(spread.seeds, (std::vector<std::uint64_t>{3, 4, 9}));
  EXPECT_EQ(spread.passed, 2U);
  ASSERT_EQ(spread.rows.size(), 2U);
  const SpreadRow& height = spread.rows[0];
  EXPECT_EQ(height.met, 2U);
  EXPECT_TRUE(near(height.mean, 4.5, stated(1e-12, "round-off")));
  EXPECT_TRUE(near(height.sigma, 1.5, stated(1e-12, "round-off")));
  EXPECT_EQ(height.lowest_seed, 3U);
  EXPECT_EQ(height.highest_seed, 9U);
  EXPECT_EQ(height.least_margin_seed, 9U);
  EXPECT_TRUE(near(height.least_margin, -1.0, stated(1e-12, "round-off")));
  EXPECT_EQ(spread.rows[1].name, "height (2)");
  EXPECT_EQ(spread.rows[1].runs, 2U);
  const std::string text = spread_text(spread);
  EXPECT_NE(text.find("hover on 3 seeds: 2 passed"), std::string::npos) << text;
  EXPECT_NE(text.find("2/3   height (2)"), std::string::npos)
      << text;  // one run did not come so far
}

// It is among those that did not meet it, and spoils no mean.
TEST(Spread, KeepsWhatCouldNotBeMeasuredOutOfTheMean) {
  std::vector<SeedRun> runs{run_on(1, {2.0}), run_on(2, {std::nan("")}), run_on(3, {4.0})};
  const SpreadRow row = spread_of(all(runs)).rows.front();
  EXPECT_EQ(row.runs, 3U);
  EXPECT_EQ(row.met, 2U);
  EXPECT_TRUE(near(row.mean, 3.0, stated(1e-12, "round-off")));
  EXPECT_EQ(spread_csv(all(runs)),
            "expectation,seed,measured,unit,wanted,margin,verdict\n"
            "\"height\",1,2,\"cm\",\"at most 5 cm\",3,pass\n"
            "\"height\",2,,\"cm\",\"at most 5 cm\",,fail\n"
            "\"height\",3,4,\"cm\",\"at most 5 cm\",1,pass\n");
}

TEST(Spread, OfOneRunHasNoSigmaAndSaysWhereLimitsDiffer) {
  EXPECT_TRUE(std::isnan(spread_of(all({run_on(1, {2.0})})).rows.front().sigma));
  std::vector<SeedRun> runs{run_on(1, {2.0}), run_on(2, {2.0})};
  runs[1].report.expectations[0].high = 6.0;
  EXPECT_EQ(spread_of(all(runs)).rows.front().limit, "at most 5 cm ...");
}

// A ramp of the seed's slope from a time of its own on.
SeedRun recorded(const std::string& folder, std::uint64_t seed) {
  SeedRun run = run_on(seed, {1.0});
  run.folder = folder;
  Expectation& e = run.report.expectations.front();
  e.signals = {"height"};
  e.from_s = 0.1 * static_cast<double>(seed);
  e.to_s = e.from_s + 1.0;
  MessageWriter writer(
      folder + "/messages.whirl",
      {"hover", seed, 1'000'000, {{"tilt", "rad", "rad"}, {"height", "m", "m"}}, {{}}});
  for (int row = 0; row < 2000; ++row) {
    const double since_s = 1e-3 * row - e.from_s;
    const std::vector<double> values{0.5, static_cast<double>(seed) * since_s};
    writer.add_row(1'000'000LL * row, values);
  }
  EXPECT_TRUE(writer.finish().ok());
  return run;
}

TEST(Overlay, LaysWindowsOverFromTheirOwnBeginnings) {
  const ScratchFolder one, two, three;
  const std::vector<SeedRun> runs{recorded(one.path(), 1), recorded(two.path(), 2),
                                  recorded(three.path(), 3)};
  const auto charts = overlays(all(runs));
  ASSERT_TRUE(charts.ok()) << charts.error().message();
  ASSERT_EQ(charts.value().size(), 1U);
  const Chart& chart = charts.value().front();
  EXPECT_EQ(chart.title, "height: height");
  ASSERT_EQ(chart.curves.size(), 6U);  // of three seeds, their mean, sigma above and below
  const ChartCurve &mean = chart.curves[3], &above = chart.curves[4];
  EXPECT_TRUE(chart.curves[2].faint && !mean.faint);
  for (std::size_t i = 1; i + 1 < mean.x.size(); ++i) {
    const auto point = stated(0.02, "a point is 3.3 ms wide, of slopes up to 3");
    EXPECT_TRUE(near(mean.y[i], 2.0 * mean.x[i], point)) << mean.x[i];
    EXPECT_TRUE(near(above.y[i] - mean.y[i], mean.x[i], point)) << mean.x[i];
  }
}

TEST(Overlay, SaysWhichMessagesCannotBeRead) {
  const ScratchFolder folder;
  SeedRun run = recorded(folder.path(), 1);
  run.folder += "/gone";
  const auto charts = overlays({&run});
  ASSERT_FALSE(charts.ok());
  EXPECT_NE(charts.error().message().find("/gone"), std::string::npos);
}

TEST(Spread, IsFiledAsPageAndTable) {
  const ScratchFolder one, two, out;
  const std::vector<SeedRun> runs{recorded(one.path(), 1), recorded(two.path(), 2)};
  const auto page = file_spread(out.path() + "/seeds", "hover", spread_of(all(runs)), all(runs));
  ASSERT_TRUE(page.ok()) << page.error().message();
  const auto html = read_whole_file(page.value());
  ASSERT_TRUE(html.ok());
  EXPECT_NE(html.value().find("2 of 2 seeds passed"), std::string::npos);
  EXPECT_TRUE(read_whole_file(out.path() + "/seeds/hover.csv").ok());
}

}  // namespace
}  // namespace whirl::results

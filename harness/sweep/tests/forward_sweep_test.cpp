#include "harness/sweep/forward_sweep.hpp"

#include <fstream>
#include <numbers>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "harness/catalogue/propeller_file.hpp"
#include "harness/sweep/validity_tally.hpp"

namespace whirl::sweep {
namespace {

Result<MeasuredFile> measured(const std::string& name, const std::string& text) {
  const ScratchFolder folder;
  const std::string path = folder.file(name);
  std::ofstream(path) << text;
  return read_measured(path);
}

TEST(Measured, ColumnsComeInAnyOrderAndTheSpeedFromTheNameIfNeedBe) {
  const auto with = measured("mine.txt", "CP CT J rpm eta\n0.04 0.1 0.2 6000 0.5\n# end\n");
  ASSERT_TRUE(with.ok()) << with.error().message();
  EXPECT_TRUE(near(with.value().points[0].CT, 0.1, round_off(1, 0.1)));
  EXPECT_TRUE(near(with.value().points[0].advance_ratio, 0.2, round_off(1, 0.2)));
  const auto named = measured("apc_kt1_6000.txt", "J CT CP eta\n0.2 0.1 0.04 0.5\n");
  ASSERT_TRUE(named.ok());
  EXPECT_EQ(named.value().points[0].omega_radps, with.value().points[0].omega_radps);
}

TEST(Measured, FaultsAreToldWithTheirLine) {
  const auto message = [](const char* name, const char* text) {
    const auto read = measured(name, text);
    return read.ok() ? std::string("accepted") : read.error().message();
  };
  EXPECT_NE(message("a_6000.txt", "J thrust\n").find(":1: no columns CT and CP"),
            std::string::npos);
  EXPECT_NE(message("mine.txt", "J CT CP\n").find("no speed"), std::string::npos);
  EXPECT_NE(message("a_6000.txt", "J CT CP\n0.1 x 0.2\n").find(":2: a number"), std::string::npos);
  EXPECT_NE(message("a_6000.txt", "J CT CP\n").find("no rows"), std::string::npos);
  EXPECT_NE(message("a_6000.txt", "J CT CP\n9 0.1 0.1\n").find("out of range"), std::string::npos);
}

TEST(ForwardSweep, PointsOnTheCurveHaveNoErrorAndShiftedOnesTheirShift) {
  const auto prop = catalogue::read_propeller_file(std::string(WHIRL_ROOT) +
                                                   "/test_plans/propellers/apcsf_9x4.7.lua");
  ASSERT_TRUE(prop.ok()) << prop.error().message();
  const auto& fit = prop.value().fit;
  MeasuredFile file{"mine", {{500.0, 0.0, 0, 0}, {500.0, 0.2, 0, 0}, {500.0, 0.4, 0, 0}}};
  const auto told = plant::predict(fit->axial, fit->belief, file.points);
  for (std::size_t i = 0; i < told.size(); ++i) {
    file.points[i].CT = told[i].mean.CT, file.points[i].CP = 1.25 * told[i].mean.CP;
  }
  const ForwardSweep sweep = forward_sweep({prop.value().blade, fit.get()}, {file}, {});
  EXPECT_EQ(sweep.flight.points, 2);
  EXPECT_TRUE(near(sweep.flight.CT_percent, 0.0, stated(1e-9, "the same curve")));
  EXPECT_TRUE(near(sweep.flight.CP_percent, 20.0, stated(1e-9, "0.25 of 1.25")));
  EXPECT_TRUE(near(sweep.flight.CP_mean_percent, -20.0, stated(1e-9, "told too little")));
  EXPECT_TRUE(near(sweep.at_rest.CP_percent, 20.0, stated(1e-9, "0.25 of 1.25")));
  EXPECT_TRUE(near(sweep.flight.CT_inside_percent, 100.0, stated(1e-9, "on the curve")));
}

TEST(ForwardSweep, SpeedsAndAdvanceRatiosAreThoseAskedForAndEveryCurveHasItsName) {
  const auto prop = catalogue::read_propeller_file(std::string(WHIRL_ROOT) +
                                                   "/test_plans/propellers/apcsf_9x4.7.lua");
  ASSERT_TRUE(prop.ok()) << prop.error().message();
  Options options;
  options.speeds_radps = {300.0, 400.0};  // 2865 and 3820 rpm
  options.advance_ratios = {0.15};
  const MeasuredFile file{"mine", {{400.0, 0.0, 0.1, 0.05}, {500.0, 0.3, 0.08, 0.045}}};
  const auto sweep = forward_sweep({prop.value().blade, prop.value().fit.get()}, {file}, options);
  const auto names = [](const results::Chart& chart) {
    std::vector<std::string> all;
    for (const auto& curve : chart.curves) all.push_back(curve.name);
    return all;
  };
  const auto three = [](const std::string& name) {
    return std::vector<std::string>{name, name + ", 90 % band, lower", name + ", 90 % band, upper"};
  };
  std::vector<std::string> over_J, over_speed = three("J = 0.15");
  for (const char* speed : {"2865 rpm", "3820 rpm", "4775 rpm"}) {
    for (const std::string& name : three(speed)) over_J.push_back(name);
  }
  over_J.emplace_back("mine"), over_speed.emplace_back("mine");
  ASSERT_EQ(sweep.charts.size(), 4u);
  for (const int i : {0, 1}) EXPECT_EQ(names(sweep.charts.at(static_cast<std::size_t>(i))), over_J);
  for (const int i : {2, 3}) {
    EXPECT_EQ(names(sweep.charts.at(static_cast<std::size_t>(i))), over_speed);
  }
  for (const results::Chart& chart : sweep.charts) {
    for (std::size_t i = 0; i < chart.curves[0].x.size(); ++i) {
      EXPECT_LT(chart.curves[1].y[i], chart.curves[0].y[i]);
      EXPECT_GT(chart.curves[2].y[i], chart.curves[0].y[i]);
    }
  }
  std::string figures;
  for (const auto& f : sweep.charts[3].figures) figures += f.name + "\n";
  EXPECT_EQ(figures,
            "mine, at rest: CP, WMAPE\nmine, at rest: CP, mean error\nall at rest: CP, WMAPE\nall "
            "at rest: CP, mean error\n");
}

// Turned by 14 deg most of the disc is past stall at rest, and no longer where the air comes towards it.
TEST(ForwardSweep, WhereTheModelIsNotValidTheCurvesSaySo) {
  const auto prop = catalogue::read_propeller_file(std::string(WHIRL_ROOT) +
                                                   "/test_plans/propellers/hk_10x4.5.lua");
  ASSERT_TRUE(prop.ok()) << prop.error().message();
  plant::PropellerDescription steep = prop.value().twist->description;
  for (auto& station : steep.stations) station.angle_rad += 14.0 * std::numbers::pi / 180.0;
  const auto twist = plant::make_fitted_blade(steep).value();
  Options options;
  options.speeds_radps = {600.0};  // 5730 rpm
  options.advance_ratios = {0.0};
  const auto sweep = forward_sweep({twist.blade, nullptr, &twist}, {}, options);
  EXPECT_NE(sweep.charts[0].note.find("5730 rpm: "), std::string::npos) << sweep.charts[0].note;
  EXPECT_NE(sweep.charts[0].note.find("from 0 to "), std::string::npos) << sweep.charts[0].note;
  EXPECT_NE(sweep.charts[1].note.find("stall ("), std::string::npos) << sweep.charts[1].note;
  // Its computed section opens power.
  const auto& curves = sweep.charts[1].curves;
  EXPECT_EQ(curves[1].name, curves[0].name + ", least drag");
  EXPECT_LT(curves[1].y[12], curves[0].y[12]);
  EXPECT_GT(curves[2].y[12], curves[0].y[12]);
}

TEST(ValidityTally, SaysHowManyWhereAndWhy) {
  ValidityTally tally;
  tally.add(0.0, {});
  EXPECT_EQ(tally.note(), "");
  tally.add(0.1, {.stalled = true});
  tally.add(0.2, {.vortex_ring = true, .stalled = true});
  tally.add(0.3, {});
  EXPECT_EQ(tally.note(),
            "2 of 4 points, from 0.1 to 0.2, lie outside the model's stated validity: vortex ring "
            "(1), stall (2)");
}

}  // namespace
}  // namespace whirl::sweep

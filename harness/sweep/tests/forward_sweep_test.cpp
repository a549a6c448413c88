#include "harness/sweep/forward_sweep.hpp"

#include <fstream>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "harness/catalogue/propeller_file.hpp"

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
  const ForwardSweep sweep = forward_sweep({prop.value().blade, fit.get()}, {file}, 600.0);
  EXPECT_EQ(sweep.flight.points, 2);
  EXPECT_TRUE(near(sweep.flight.CT_percent, 0.0, stated(1e-9, "the same curve")));
  EXPECT_TRUE(near(sweep.flight.CP_percent, 20.0, stated(1e-9, "0.25 of 1.25")));
  EXPECT_TRUE(near(sweep.flight.CP_mean_percent, -20.0, stated(1e-9, "told too little")));
  EXPECT_TRUE(near(sweep.at_rest.CP_percent, 20.0, stated(1e-9, "0.25 of 1.25")));
  EXPECT_TRUE(near(sweep.flight.CT_inside_percent, 100.0, stated(1e-9, "on the curve")));
}

}  // namespace
}  // namespace whirl::sweep

#include "plant/rotor/polar.hpp"

#include "base/near.hpp"
#include "plant/rotor/tests/test_blades.hpp"

namespace whirl::plant {
namespace {

constexpr double kDeg = 3.14159265358979323846 / 180.0;
constexpr const char* kSmall =
    "section s # a comment\nreynolds 50000\n-4 -0.2 0.05\n-2 0 0.03\n0 0.2 0.02\n4 0.6 0.02\n8 0.9 "
    "0.04\nreynolds 200000\n-4 -0.4 0.04\n-2 0 0.02\n0 0.4 0.01\n4 0.8 0.01\n8 1.2 0.02\n";

std::string error_of(const std::string& text) {
  return read_polar(text, "x.polar").error().message();
}

TEST(Polar, PrintedRowsComeBackAndReynoldsIsMixedInItsLogarithm) {
  const PolarFamily p = read_polar(kSmall, "x.polar").value();
  EXPECT_EQ(p.name(), "s");
  EXPECT_TRUE(near(p.at(4.0 * kDeg, 50000).cl, 0.6, round_off(8, 1.0)));
  EXPECT_TRUE(near(p.at(2.0 * kDeg, 200000).cl, 0.6, round_off(8, 1.0)));
  EXPECT_TRUE(near(p.at(4.0 * kDeg, 100000).cl, 0.7, round_off(64, 1.0)));
  EXPECT_TRUE(near(p.at(4.0 * kDeg, 100000).cd, 0.015, round_off(64, 1.0)));
}

// A plate broadside on: no lift, drag of order one; the flow from behind pulls the other way.
TEST(Polar, FullCircleRunsIntoAPlate) {
  const auto p = section("naca4412");
  EXPECT_TRUE(near(p->at(90.0 * kDeg, 1e5).cl, 0.0, stated(0.05, "broadside on")));
  EXPECT_TRUE(near(p->at(90.0 * kDeg, 1e5).cd, 1.25, stated(0.1, "Viterna, aspect ratio 8")));
  EXPECT_GT(p->at(45.0 * kDeg, 1e5).cl, 0.4);
  EXPECT_LT(p->at(135.0 * kDeg, 1e5).cl, -0.4);
  for (double deg = -180.0; deg < 180.0; deg += 0.25) {
    const auto a = p->at(deg * kDeg, 6e4);
    const auto b = p->at((deg + 0.25) * kDeg, 6e4);
    ASSERT_TRUE(near(b.cl, a.cl, stated(0.12, "no jump anywhere"))) << deg;
    ASSERT_GT(a.cd, 0.0) << deg;
  }
}

TEST(Polar, FaultsAreNamedWithTheirLine) {
  EXPECT_EQ(error_of("1 2 3\n"), "x.polar:1: row before the first reynolds line (add reynolds RE)");
  EXPECT_EQ(error_of("reynolds 60000\n0 a 0.1\n"),
            "x.polar:2: 'a' is no number (write alpha_deg cl cd)");
  EXPECT_EQ(error_of("reynolds 60000\n0 1\n"),
            "x.polar:2: a row has three numbers (write alpha_deg cl cd)");
  EXPECT_EQ(error_of("reynolds 60000\n2 0 0.1\n1 0 0.1\n"),
            "x.polar:3: angles must ascend (sort the rows of this block)");
  EXPECT_EQ(error_of("reynolds -5\n"),
            "x.polar:1: reynolds wants one number from 1e3 to 1e8 (write e.g. reynolds 60000)");
  EXPECT_EQ(error_of("reynolds 60000\n0 0 -0.1\n"), "x.polar:2: drag must lie between 0 and 5");
  EXPECT_EQ(error_of("reynolds 60000\n0 0 0.1\n"),
            "x.polar:2: a block needs at least 5 rows (give angles from below zero lift to stall)");
  EXPECT_FALSE(read_polar("", "x.polar").ok());
}

TEST(Polar, ErrorOfItsDragIsReadAndDragScales) {
  EXPECT_EQ(read_polar(kSmall, "x").value().drag_within(), 0.0);
  const auto p = read_polar(std::string("drag_within 0.2\n") + kSmall, "x.polar").value();
  EXPECT_EQ(p.drag_within(), 0.2);
  const auto more = p.with_drag(1.5);
  EXPECT_EQ(more.at(0.0, 50000).cl, p.at(0.0, 50000).cl);
  EXPECT_TRUE(near(more.at(0.0, 50000).cd, 1.5 * p.at(0.0, 50000).cd, round_off(4, 0.05)));
  EXPECT_EQ(
      error_of("drag_within 1\n"),
      "x.polar:1: drag_within wants one number from 0 to below 1 (the share by which drag may "
      "be off, e.g. drag_within 0.22)");
  EXPECT_EQ(error_of("drag_within -0.1\n").substr(0, 9), "x.polar:1");
}

TEST(Polar, EveryFamilyOfTheHouseReads) {
  for (const char* name : {"bw3", "clark_y", "e63", "goe417a", "naca4412", "naca6409"}) {
    const auto p = section(name);
    EXPECT_EQ(p->name(), name);
    const auto line = p->attached(1e5);
    EXPECT_GT(line.slope_per_rad, 4.0) << name;
    EXPECT_LT(line.slope_per_rad, 11.0) << name;  // a thin plate's curve at low Re steps upward
    EXPECT_LT(line.alpha0_rad, 0.0) << name;
  }
}

}  // namespace
}  // namespace whirl::plant

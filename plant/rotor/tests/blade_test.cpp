#include "plant/rotor/blade.hpp"

#include <array>
#include <cstdio>
#include <functional>

#include "base/near.hpp"
#include "plant/rotor/tests/test_blades.hpp"
#include "plant/rotor/twist_fit.hpp"

namespace whirl::plant {
namespace {

constexpr double kDeg = 3.14159265358979323846 / 180.0;

PropellerDescription good() {
  PropellerDescription d = hobbyking_10x4_5(section("bw3"), section("e63"));
  d.place = "p.lua";
  return d;
}

std::string error_after(const std::function<void(PropellerDescription&)>& spoil) {
  PropellerDescription d = good();
  spoil(d);
  const auto blade = make_blade(d);
  return blade ? "accepted" : blade.error().message();
}

TEST(Blade, BadDescriptionsAreRefusedWithPlaceAndCure) {
  EXPECT_EQ(error_after([](auto& d) { d.blade_count = 0; }), "p.lua: blades: 0 is outside 1..8");
  EXPECT_EQ(error_after([](auto& d) { d.stations[3].r_over_R = 0.1; }),
            "p.lua: stations[4]: r must ascend within 0..1 (r is the radius over the tip radius)");
  EXPECT_EQ(error_after([](auto& d) { d.stations[2].c_over_R = -0.1; }),
            "p.lua: stations[3]: c must lie within 0..1 (c is c/R)");
  EXPECT_EQ(error_after([](auto& d) { d.stations[0].angle_rad = 30.0; }),
            "p.lua: stations[1]: beta beyond 80 deg (give degrees)");
  EXPECT_EQ(error_after([](auto& d) { d.stations.resize(5); }),
            "p.lua: stations must reach from below 0.5 R to the tip (add the missing rows)");
  EXPECT_EQ(error_after([](auto& d) { d.sections.clear(); }),
            "p.lua: polars: none given (name at least one section)");
  for (const double bad : {-1.0, 0.0, std::nan(""), 1e9}) {
    EXPECT_NE(error_after([&](auto& d) { d.diameter_m = bad; }), "accepted") << bad;
    EXPECT_NE(error_after([&](auto& d) { d.mass_kg = bad; }), "accepted") << bad;
    EXPECT_NE(error_after([&](auto& d) { d.induced_factor = bad; }), "accepted") << bad;
    EXPECT_NE(error_after([&](auto& d) { d.flap_stiffness_Nm_per_rad = bad; }), "accepted") << bad;
  }
}

// Stall delay only adds lift beyond the 2-D stall, so the attached part must come back as it was.
TEST(Blade, TableGivesWhatThePolarSays) {
  PropellerDescription d = good();
  d.stall_delay = false;
  d.sections = {{0.2, section("naca4412")}};
  const auto blade = make_blade(d).value();
  const auto polar = section("naca4412");
  for (const double re : {4e4, 7e4, 1.5e5}) {
    for (double deg = -10.2; deg < 20.0; deg += 0.7) {
      const auto got = look_up(blade->rings[10].table, reynolds_slot(re), deg * kDeg);
      const auto want = polar->at(deg * kDeg, re);
      EXPECT_TRUE(
          near(got.cl, want.cl, stated(0.04, "20 levels cut the kinks where given curves meet")))
          << re << " " << deg;
      EXPECT_TRUE(near(got.cd, want.cd, stated(0.13 * want.cd, "the same"))) << re << " " << deg;
    }
  }
}

// The thesis identifies 3.752e-5 kg m2 for rotor and propeller; the propeller is the larger part.
TEST(Blade, InertiaOfThePropellerFitsTheIdentifiedRotor) {
  const double I = polar_inertia_kgm2(*hobbyking());
  EXPECT_GT(I, 0.4 * 3.752e-5);
  EXPECT_LT(I, 3.752e-5);
}

// The plan file and the C++ description of the Hobbyking are typed apart and must agree.
TEST(Blade, LuaFileAndDescriptionOfTheHobbykingAgree) {
  std::ifstream in(std::string(WHIRL_PROPELLERS) + "/hk_10x4.5.lua");
  std::vector<std::array<double, 3>> rows;
  for (std::string line; std::getline(in, line);) {
    std::array<double, 3> r{};
    if (std::sscanf(line.c_str(), " { r = %lf, c = %lf, beta = %lf }", &r[0], &r[1], &r[2]) == 3) {
      rows.push_back(r);
    }
  }
  const auto d = good();
  ASSERT_EQ(rows.size(), d.stations.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_TRUE(near(rows[i][0], d.stations[i].r_over_R, round_off(2, 1.0)));
    EXPECT_TRUE(near(rows[i][1], d.stations[i].c_over_R, round_off(2, 1.0)));
    EXPECT_TRUE(near(rows[i][2] * kDeg, d.stations[i].angle_rad, round_off(4, 1.0)));
  }
}

TEST(Blade, TwistFitFindsTheTwistThatMadeTheThrust) {
  PropellerDescription d = good();
  d.tip_twist_correction_rad = 1.7 * kDeg;
  const auto blade = make_blade(d).value();
  std::vector<StaticPoint> points;
  for (const double w : {350.0, 450.0, 550.0}) {
    points.push_back({w, propeller_coefficients(blade, w, 0.0).CT});
  }
  EXPECT_TRUE(near(fit_tip_twist_rad(d, points).value(), 1.7 * kDeg, stated(1e-4, "bisection")));
  d.tip_twist_correction_rad = 0.0;
  d.static_points = points;
  EXPECT_TRUE(near(propeller_coefficients(make_fitted_blade(d).value().blade, 450.0, 0.0).CT,
                   points[1].thrust_coefficient, stated(1e-4, "bisection")));
  points[0].thrust_coefficient = 5.0;
  EXPECT_FALSE(fit_tip_twist_rad(d, points).ok());
  EXPECT_FALSE(fit_tip_twist_rad(d, {}).ok());
}

// What a stand would show of the blade, turned by this at the tip.
std::vector<StaticPoint> stand_rows(PropellerDescription d, double twist_deg, double power = 1.0) {
  d.tip_twist_correction_rad = twist_deg * kDeg;
  const auto blade = make_blade(d).value();
  std::vector<StaticPoint> rows;
  for (const double w : {350.0, 450.0, 550.0}) {
    const auto k = propeller_coefficients(blade, w, 0.0);
    rows.push_back({w, k.CT, power * k.CP});
  }
  return rows;
}

// `flatter_deg`: so much less at the tip before it, for `good` itself is stalled at rest from 4 deg on.
Result<TwistedBlade> on_rows(double twist_deg, double power = 1.0, double flatter_deg = 0.0) {
  PropellerDescription d = good();
  for (PropellerStation& s : d.stations) s.angle_rad -= flatter_deg * kDeg * s.r_over_R;
  d.static_points = stand_rows(d, twist_deg, power);
  return make_fitted_blade(d);
}

TEST(TwistedBlade, SoundRowsLeaveNothingOverAndNothingIsDoubted) {
  const auto made = on_rows(1.7).value();
  EXPECT_TRUE(made.found);
  EXPECT_TRUE(near(made.tip_twist_rad, 1.7 * kDeg, stated(1e-4, "bisection")));
  EXPECT_TRUE(near(made.thrust_off, 0.0, stated(1e-3, "bisection")));
  EXPECT_TRUE(near(made.power_off, 0.0, stated(1e-3, "bisection")));
  EXPECT_GT(made.answer_per_deg, 0.03);  // of a healthy blade
  EXPECT_LT(made.answer_per_deg, 0.06);
  EXPECT_TRUE(made.doubts.empty()) << made.doubts.front();
}

TEST(TwistedBlade, PowerThatItsSectionsDoNotTakeIsDoubted) {
  const auto made = on_rows(1.7, 1.25).value();
  EXPECT_TRUE(near(made.power_off, 0.2, stated(1e-3, "0.25 of 1.25")));
  ASSERT_EQ(made.doubts.size(), 1u);
  EXPECT_NE(made.doubts[0].find("static power is left over by 20 %"), std::string::npos);
  EXPECT_TRUE(on_rows(1.7, 1.09).value().doubts.empty());
}

TEST(TwistedBlade, TwistOutsideMinus1To4DegIsDoubtedAndBeyond2MoreRefused) {
  for (const auto& [deg, doubts] : {std::pair(3.8, 0u), {4.3, 1u}, {5.5, 1u}, {-1.5, 1u}}) {
    const auto made = on_rows(deg, 1.0, 5.0).value();
    ASSERT_EQ(made.doubts.size(), doubts) << deg;
    if (doubts > 0) {
      EXPECT_NE(made.doubts[0].find("tip twist of"), std::string::npos);
    }
  }
  for (const double deg : {6.3, -3.3}) EXPECT_FALSE(on_rows(deg, 1.0, 5.0).ok()) << deg;
  PropellerDescription given = good();
  given.tip_twist_correction_rad = 5.0 * kDeg;
  const auto made = make_fitted_blade(given).value();
  EXPECT_FALSE(made.found);
  EXPECT_EQ(made.doubts.size(), 1u);
}

// Near the most that it can lift at all: thrust cannot tell the angle.
TEST(TwistedBlade, AStalledBladeIsDoubted) {
  const auto made = on_rows(3.95).value();
  EXPECT_LT(made.answer_per_deg, kLeast_answer);
  ASSERT_EQ(made.doubts.size(), 1u);
  EXPECT_NE(made.doubts[0].find("hardly answers to twist"), std::string::npos) << made.doubts[0];
}

// Profile power is a third to a half of the whole at rest, of which the computed section has its share.
TEST(TwistedBlade, StatedErrorOfComputedDragOpensItsPower) {
  const auto made = make_fitted_blade(good()).value();
  EXPECT_TRUE(near(made.drag_within, 0.22, round_off(1, 0.22)));  // e63.polar
  const auto CP = [](const std::shared_ptr<const Blade>& blade) {
    return propeller_coefficients(blade, 450.0, 0.0).CP;
  };
  const double middle = CP(made.blade);
  EXPECT_LT(CP(with_section_drag(made, -1)), 0.99 * middle);
  EXPECT_GT(CP(with_section_drag(made, -1)), 0.85 * middle);
  EXPECT_GT(CP(with_section_drag(made, +1)), 1.01 * middle);
  EXPECT_LT(CP(with_section_drag(made, +1)), 1.15 * middle);
  PropellerDescription measured = good();
  for (SectionStation& s : measured.sections) s.polar = section("bw3");
  EXPECT_EQ(make_fitted_blade(measured).value().drag_within, 0.0);
}

}  // namespace
}  // namespace whirl::plant

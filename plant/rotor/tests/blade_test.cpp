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
  EXPECT_TRUE(near(propeller_coefficients(make_fitted_blade(d).value(), 450.0, 0.0).CT,
                   points[1].thrust_coefficient, stated(1e-4, "bisection")));
  points[0].thrust_coefficient = 5.0;
  EXPECT_FALSE(fit_tip_twist_rad(d, points).ok());
  EXPECT_FALSE(fit_tip_twist_rad(d, {}).ok());
}

}  // namespace
}  // namespace whirl::plant

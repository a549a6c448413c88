// A blade whose section is fitted: the fast solver against the rotor, what a fit finds and what it doubts.
#include <Eigen/Cholesky>
#include <fstream>
#include <random>
#include <sstream>

#include "base/near.hpp"
#include "plant/rotor/blade_rings.hpp"
#include "plant/rotor/fitted_blade.hpp"
#include "plant/rotor/known_blades.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::plant {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadps_per_rpm = kPi / 30.0;

std::shared_ptr<const KnownBlades> known() {
  static const auto all = [] {
    std::ifstream in(std::string(WHIRL_DATA) + "/propellers/known.txt");
    std::stringstream text;
    text << in.rdbuf();
    return std::make_shared<const KnownBlades>(read_known(text.str(), "known.txt").value());
  }();
  return all;
}

// APC slow fly 10x4.7 [UiucProp], which is not among the known; every third station.
PropellerDescription slow_flyer() {
  PropellerDescription d;
  d.place = d.name = "slow flyer";
  d.make = "APC";
  d.diameter_m = 0.254;
  d.mass_kg = 0.009;
  const double rows[][3] = {{0.15, 0.109, 21.11}, {0.30, 0.173, 23.49}, {0.45, 0.217, 17.33},
                            {0.60, 0.227, 12.90}, {0.75, 0.200, 10.08}, {0.90, 0.136, 7.69},
                            {1.00, 0.044, 5.40}};
  for (const auto& r : rows) d.stations.push_back({r[0], r[1], r[2] * kPi / 180.0});
  d.known = known();
  return d;
}

// What such a blade with these traits would show on a stand.
std::vector<StaticPoint> rows_of(const PropellerDescription& d, const TraitVector& traits) {
  std::vector<StaticPoint> rows;
  for (const double rpm : {2500.0, 4000.0, 5500.0}) {
    const auto k =
        axial_coefficients(axial_blade(d, kRing_count), traits, rpm * kRadps_per_rpm, 0.0);
    rows.push_back({rpm * kRadps_per_rpm, k.CT, k.CP});
  }
  return rows;
}

TraitVector usual() {
  return known()->prior_for(blade_shape(slow_flyer().stations), false).mean;
}

TEST(BladeFit, TheFastSolverAgreesWithTheRotorInHoverAndFlight) {
  PropellerDescription d = slow_flyer();
  TraitBelief belief;
  belief.mean = usual();
  belief.mean[hover_loss] = 1.15;  // far from none
  d.traits = std::make_shared<const TraitBelief>(belief);
  const auto blade = make_blade(d).value();
  const AxialBlade axial = axial_blade(d, kRing_count);
  for (const double J : {0.0, 0.2, 0.4}) {
    const auto fast = axial_coefficients(axial, belief.mean, 500.0, J);
    const auto slow = propeller_coefficients(blade, 500.0, J);
    EXPECT_TRUE(near(fast.CT, slow.CT, stated(0.01 * 0.1, "tables and mean Reynolds numbers")));
    EXPECT_TRUE(near(fast.CP, slow.CP, stated(0.01 * 0.045, "tables and mean Reynolds numbers")));
  }
}

TEST(BladeFit, TwistByTheSquareOfTheSpeedReachesTheRotor) {
  PropellerDescription d = slow_flyer();
  const auto at = [&](double twist_deg, double omega) {
    TraitBelief belief;
    belief.mean = usual();
    belief.mean[speed_twist_deg] = twist_deg;
    d.traits = std::make_shared<const TraitBelief>(belief);
    return propeller_coefficients(make_blade(d).value(), omega, 0.0).CT;
  };
  const double slow = at(2.0, 100.0) - at(0.0, 100.0);
  const double fast = at(2.0, 500.0) - at(0.0, 500.0);
  EXPECT_GT(slow, 0.0);
  EXPECT_GT(fast, 15.0 * slow);  // 25 in twist; the slope of lift differs a little
  EXPECT_LT(fast, 40.0 * slow);
}

TEST(BladeFit, MoreTwistAndMoreDragAreFoundOnStaticRows) {
  PropellerDescription d = slow_flyer();
  TraitVector truth = usual();
  truth[ln_least_drag] += 0.3;
  truth[tip_twist_deg] += 1.0;
  d.static_points = rows_of(d, truth);
  const auto fit = fit_blade(d).value();
  EXPECT_LT(fit.thrust_off, 0.01);
  EXPECT_LT(fit.power_off, 0.02);
  EXPECT_TRUE(fit.doubts.empty()) << fit.doubts.front();
  const auto there = axial_coefficients(fit.axial, truth, 500.0, 0.4);
  const auto told = predict(fit.axial, fit.belief, {{500.0, 0.4, 0.0, 0.0}}).front();
  EXPECT_TRUE(
      near(told.mean.CT, there.CT, stated(kNine_in_ten * told.deviation.CT, "its own band")));
  EXPECT_TRUE(
      near(told.mean.CP, there.CP, stated(kNine_in_ten * told.deviation.CP, "its own band")));
}

TEST(BladeFit, StaticRowsNarrowTheBand) {
  PropellerDescription d = slow_flyer();
  const auto blind = fit_blade(d).value();
  d.static_points = rows_of(d, usual());
  const auto seeing = fit_blade(d).value();
  const auto width = [](const FittedBlade& f) {
    return predict(f.axial, f.belief, {{500.0, 0.3, 0.0, 0.0}}).front().deviation.CT;
  };
  EXPECT_LT(width(seeing), 0.8 * width(blind));
  EXPECT_FALSE(blind.doubts.empty());
}

TEST(BladeFit, ARowInFlightNarrowsTheBandAndIsDoubtedWhereNoBladeGivesIt) {
  PropellerDescription d = slow_flyer();
  d.static_points = rows_of(d, usual());
  const auto width = [](const FittedBlade& f) {
    return predict(f.axial, f.belief, {{500.0, 0.45, 0.0, 0.0}}).front().deviation.CT;
  };
  const auto alone = fit_blade(d).value();
  const auto k = axial_coefficients(alone.axial, usual(), 500.0, 0.4);
  d.flight_points = {{500.0, 0.4, k.CT, k.CP}};
  const auto flown = fit_blade(d).value();
  EXPECT_LT(width(flown), 0.8 * width(alone));
  EXPECT_TRUE(flown.doubts.empty()) << flown.doubts.front();
  d.flight_points.front().thrust_coefficient *= 2.0;  // a J of half the diameter's
  const auto wrong = fit_blade(d);
  ASSERT_TRUE(wrong.ok()) << wrong.error().message();
  ASSERT_FALSE(wrong.value().doubts.empty());
  EXPECT_NE(wrong.value().doubts.front().find("in flight"), std::string::npos)
      << wrong.value().doubts.front();
}

TEST(BladeFit, AMakeThatNobodyMeasuredHasAWiderBandAndSaysSo) {
  PropellerDescription d = slow_flyer();
  d.static_points = rows_of(d, usual());
  const auto band = [](const FittedBlade& f) {
    return predict(f.axial, f.belief, {{500.0, 0.3, 0.0, 0.0}}).front().deviation;
  };
  const auto known_make = fit_blade(d).value();
  EXPECT_TRUE(known_make.doubts.empty()) << known_make.doubts.front();
  for (const char* make : {"", "Nobody"}) {
    d.make = make;
    const auto strange = fit_blade(d).value();
    EXPECT_TRUE(near(band(strange).CT, kStrange_thrust * band(known_make).CT, round_off(4, 0.1)));
    EXPECT_TRUE(near(band(strange).CP, kStrange_power * band(known_make).CP, round_off(4, 0.1)));
    ASSERT_FALSE(strange.doubts.empty());
    EXPECT_NE(strange.doubts.back().find("make"), std::string::npos);
  }
}

// Drawn from the belief, blades that lift one thrust, each at the speed that it takes for it.
TEST(BladeFit, PowerOfAThrustIsAsUncertainAsBladesDrawnFromTheBeliefSpread) {
  PropellerDescription d = slow_flyer();
  d.static_points = rows_of(d, usual());
  const auto fit = fit_blade(d).value();
  const double wanted =
      axial_coefficients(fit.axial, fit.belief.mean, 500.0, 0.0).CT * 500.0 * 500.0;
  const TraitMatrix root = fit.belief.covariance.llt().matrixL();
  std::mt19937_64 chance(1);
  std::normal_distribution<double> normal;
  constexpr int kBlades = 400;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kBlades; ++i) {
    TraitVector z;
    for (int k = 0; k < kTraits; ++k) z[k] = normal(chance);
    const TraitVector traits = fit.belief.mean + root * z;
    double omega = 500.0, CP = 0.0;
    for (int round = 0; round < 6; ++round) {
      const auto k = axial_coefficients(fit.axial, traits, omega, 0.0);
      omega = std::sqrt(wanted / k.CT), CP = k.CP;
    }
    const double power = std::log(CP * omega * omega * omega);
    sum += power, squares += power * power;
  }
  const double spread = std::sqrt(squares / kBlades - sum / kBlades * sum / kBlades);
  const double own = std::hypot(0.041, 1.5 * 0.033);
  EXPECT_TRUE(near(lifting_power_deviation(fit.axial, fit.belief, 500.0), std::hypot(spread, own),
                   stated(0.06 * std::hypot(spread, own), "400 blades; slopes instead of curves")));
  TraitBelief strange = fit.belief;
  strange.strange_make = true;
  EXPECT_TRUE(near(lifting_power_deviation(fit.axial, strange, 500.0),
                   1.45 * lifting_power_deviation(fit.axial, fit.belief, 500.0),
                   round_off(8, 0.1)));
}

// A stand's power in the wrong unit or of the ESC's input: drag alone would swallow it.
TEST(BladeFit, RowsThatBladesOfTheShapeDoNotGiveAreDoubted) {
  PropellerDescription d = slow_flyer();
  d.static_points = rows_of(d, usual());
  for (StaticPoint& p : d.static_points) p.power_coefficient *= 1.45;
  const auto fit = fit_blade(d);
  ASSERT_TRUE(fit.ok()) << fit.error().message();
  ASSERT_FALSE(fit.value().doubts.empty());
  EXPECT_NE(fit.value().doubts.back().find("power is +"), std::string::npos)
      << fit.value().doubts.back();
}

// Drag would swallow three times the power, and leave 7 % of it over.
TEST(BladeFit, RowsFarOffWhatTheShapeGivesAreRefused) {
  PropellerDescription d = slow_flyer();
  d.static_points = rows_of(d, usual());
  for (StaticPoint& p : d.static_points) p.power_coefficient *= 3.0;
  const auto fit = fit_blade(d);
  ASSERT_FALSE(fit.ok());
  EXPECT_NE(fit.error().message().find("static power is +"), std::string::npos)
      << fit.error().message();
}

TEST(BladeFit, WhatNoBladeOfTheShapeGivesIsRefused) {
  PropellerDescription d = slow_flyer();
  d.static_points = {{500.0, 0.9, 0.0}};
  const auto refused = fit_blade(d);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message().find("static thrust"), std::string::npos);
}

TEST(BladeFit, PowerThatNoSectionExplainsIsDoubted) {
  PropellerDescription d = slow_flyer();
  d.static_points = rows_of(d, usual());
  for (StaticPoint& p : d.static_points) p.power_coefficient *= 0.6;  // better than an ideal rotor
  const auto fit = fit_blade(d);
  ASSERT_TRUE(fit.ok());
  ASSERT_FALSE(fit.value().doubts.empty());
  EXPECT_NE(fit.value().doubts.back().find("power"), std::string::npos);
}

// Below 0.7 - 0.35 ln(Re / 60,000) of attached lift the trait's share is missing, above it nothing is.
TEST(BladeFit, LiftStepsDownByItsShareBelowAnAngleThatFallsWithReynolds) {
  TraitVector t = usual();
  t[lift_maximum] = 4.0;  // out of the way
  t[slope_power] = t[maximum_power] = 0.0;
  const auto lift = [&](double share, double attached, double reynolds) {
    t[lift_step] = share;
    const TraitSection s = trait_section(t, 0.01, reynolds);
    return coefficients(s, s.zero_lift_rad + std::asin(attached / s.slope_per_rad)).cl;
  };
  const Tolerance six_widths = stated(0.003, "a logistic, six of its widths away");
  EXPECT_TRUE(near(lift(0.2, 0.4, 60e3), 0.8 * lift(0.0, 0.4, 60e3), six_widths));
  EXPECT_TRUE(near(lift(0.2, 1.0, 60e3), lift(0.0, 1.0, 60e3), six_widths));
  EXPECT_TRUE(near(lift(0.2, 0.7, 60e3), 0.9 * lift(0.0, 0.7, 60e3), six_widths));
  EXPECT_TRUE(near(lift(0.2, 0.8, 120e3), lift(0.0, 0.8, 120e3), six_widths));
  EXPECT_TRUE(near(lift(0.2, 0.6, 30e3), 0.8 * lift(0.0, 0.6, 30e3), six_widths));
}

TEST(BladeFit, KnownBladesSurviveTheirText) {
  const auto again = read_known(known_text(*known()), "again");
  ASSERT_TRUE(again.ok());
  const BladeShape shape = blade_shape(slow_flyer().stations);
  const TraitVector a = known()->prior_for(shape, false).mean;
  const TraitVector b = again.value().prior_for(shape, false).mean;
  for (int i = 0; i < kTraits; ++i) EXPECT_TRUE(near(a[i], b[i], stated(1e-4, "eight digits")));
  EXPECT_FALSE(read_known("blade x drawn 1 2\n", "short").ok());
  EXPECT_FALSE(read_known("", "empty").ok());
}

// Sure of a shape that it has seen, less sure of one like none.
TEST(BladeFit, AStrangeShapeIsBelievedLess) {
  PropellerDescription odd = slow_flyer();
  for (PropellerStation& s : odd.stations) s.c_over_R = 0.6 - 0.5 * s.r_over_R;
  const BladeShape usual_shape = blade_shape(slow_flyer().stations);
  const BladeShape odd_shape = blade_shape(odd.stations);
  EXPECT_GT(known()->strangeness(odd_shape), known()->strangeness(usual_shape));
  EXPECT_GT(known()->prior_for(odd_shape, false).covariance(1, 1),
            1.2 * known()->prior_for(usual_shape, false).covariance(1, 1));
}

}  // namespace
}  // namespace whirl::plant

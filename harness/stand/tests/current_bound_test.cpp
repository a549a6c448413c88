#include "harness/stand/current_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "harness/catalogue/propeller_file.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::stand {
namespace {

const auto kBlade = catalogue::read_propeller(std::string(WHIRL_SOURCE_FOLDER) +
                                              "/test_plans/propellers/hk_10x4.5.lua")
                        .value();

double rise_s(const plant::MotorParams& motor, const RiseAsked& asked) {
  const auto rise = shortest_rise_s(motor, kBlade, asked);
  EXPECT_TRUE(rise.ok()) << rise.error().message();
  return rise.value();
}

// With a current of a thousand amperes the air's torque is nothing: J (w2 - w1) / (Kt (i - i0)), at the speeds where
// thrust crosses its levels. Heavy, so that the inflow has time to follow and steady() tells those speeds.
TEST(CurrentBound, IsTheSpeedToGainOverTheAccelerationWhereTheAirHardlyCounts) {
  plant::MotorParams motor;
  motor.inertia_kgm2 = 1.0;
  const RiseAsked asked{.from_N = 2.0, .to_N = 4.0, .current_A = 1e4, .wind_mps = 0.0};
  const plant::Rotor rotor(kBlade, +1);
  const auto thrust_N = [&](double w) {
    plant::RotorConditions conditions;
    conditions.omega_radps = w;
    return rotor.steady(conditions).thrust_N;
  };
  const auto speed_of = [&](double wanted_N) {
    double w = 500.0;
    for (int i = 0; i < 20; ++i) w *= std::sqrt(wanted_N / thrust_N(w));
    return w;
  };
  const double gained = speed_of(3.8) - speed_of(2.2);
  const double closed_s = gained / (motor.torque_constant_NmpA * (1e4 - motor.no_load_current_A));
  EXPECT_TRUE(near(rise_s(motor, asked), closed_s,
                   stated(0.01 * closed_s, "the inflow's lag of 20 ms at both ends of it alike")));
}

TEST(CurrentBound, FallsWithCurrentAndWindAndRisesWithInertiaAndFriction) {
  const plant::MotorParams stock;
  const RiseAsked asked{.from_N = 0.8, .to_N = 4.0, .current_A = 20.0, .wind_mps = 0.0};
  const double usual_s = rise_s(stock, asked);
  plant::MotorParams heavy = stock, rubbing = stock;
  heavy.inertia_kgm2 *= 1.1;
  rubbing.no_load_current_A += 1.0;
  EXPECT_GT(rise_s(heavy, asked), 1.08 * usual_s);
  EXPECT_GT(rise_s(rubbing, asked), 1.03 * usual_s);
  RiseAsked more = asked, windy = asked;
  more.current_A = 25.0;
  windy.wind_mps = 3.0;
  EXPECT_LT(rise_s(stock, more), 0.85 * usual_s);
  // In air from above the same thrusts lie at higher speeds, where a newton is less of a change of speed.
  EXPECT_LT(rise_s(stock, windy), 0.995 * usual_s);
  // In air of a tenth less they lie at speeds 5.4 % higher, and as far apart.
  RiseAsked thin = asked;
  thin.still.density_kgpm3 *= 0.9;
  EXPECT_GT(rise_s(stock, thin), 1.04 * usual_s);
}

TEST(CurrentBound, RefusesWhatIsNoRiseAndWhatTheCurrentDoesNotReach) {
  const plant::MotorParams motor;
  const auto complaint = [&](const RiseAsked& asked) {
    const auto rise = shortest_rise_s(motor, kBlade, asked);
    return rise ? "none" : rise.error().message();
  };
  EXPECT_NE(complaint({.from_N = 3.0, .to_N = 2.0, .current_A = 20.0}).find("is no rise"),
            std::string::npos);
  EXPECT_NE(complaint({.from_N = 0.8, .to_N = 4.0, .current_A = 3.0}).find("not reached"),
            std::string::npos);
}

}  // namespace
}  // namespace whirl::stand

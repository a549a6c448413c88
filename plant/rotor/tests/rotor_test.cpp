#include "plant/rotor/rotor.hpp"

#include "base/near.hpp"
#include "plant/rotor/tests/test_blades.hpp"

namespace whirl::plant {
namespace {

RotorLoads settled(Rotor& rotor, const RotorConditions& c, double seconds = 1.0) {
  RotorLoads loads;
  for (double t = 0.0; t < seconds; t += 1e-3) loads = rotor.step(c, 1e-3);
  return loads;
}

TEST(Rotor, HobbykingGivesTheStaticThrustOfTheThesis) {
  const Rotor rotor(hobbyking(), 1);
  for (double rpm = 3000.0; rpm <= 5500.0; rpm += 125.0) {
    const RotorLoads got = rotor.steady(hover(rpm));
    const double want_N = 1.789e-7 * rpm * rpm - 1.4715e-4 * rpm;
    EXPECT_TRUE(near(got.thrust_N, want_N, stated(0.03 * want_N, "the issue's 3 %"))) << rpm;
    EXPECT_GT(got.figure_of_merit, 0.6) << rpm;
    EXPECT_LT(got.figure_of_merit, 0.75) << rpm;
    EXPECT_TRUE(got.validity.ok()) << rpm;
  }
}

TEST(Rotor, CounterclockwiseRotorYawsTheAirframeClockwise) {
  const RotorLoads loads = Rotor(hobbyking(), 1).steady(hover(4000.0));
  EXPECT_GT(loads.tau_P_Nm.z(), 0.0);
  EXPECT_LT(loads.f_P_N.z(), 0.0);
  EXPECT_TRUE(near(loads.tau_P_Nm.z(), loads.shaft_torque_Nm, round_off(4, 0.1)));
}

TEST(Rotor, ThinnerAirCarriesLessAndClimbUnloads) {
  const Rotor rotor(hobbyking(), 1);
  RotorConditions c = hover(4500.0);
  const double sea = rotor.steady(c).thrust_N;
  c.density_kgpm3 = 1.0;
  EXPECT_LT(rotor.steady(c).thrust_N,
            sea / 1.225);  // less than in proportion: Reynolds number falls
  c = hover(4500.0);
  c.v_AP_P_mps.z() = -3.0;  // upward
  EXPECT_LT(rotor.steady(c).thrust_N, sea);
}

TEST(Rotor, AWindmillGivesPowerBackAndBrakes) {
  RotorConditions c = hover(2500.0);
  c.v_AP_P_mps.z() = -20.0;  // climbs faster than its pitch
  const RotorLoads loads = Rotor(hobbyking(), 1).steady(c);
  EXPECT_LT(loads.shaft_torque_Nm, 0.0);
  EXPECT_LT(loads.thrust_N, 0.0);
  EXPECT_EQ(loads.figure_of_merit, 0.0);
}

TEST(Rotor, DescentAtTheSpeedOfItsOwnWakeIsFlagged) {
  const Rotor rotor(hobbyking(), 1);
  RotorConditions c = hover(4500.0);
  c.v_AP_P_mps.z() = rotor.steady(c).induced_velocity_mps;
  EXPECT_TRUE(rotor.steady(c).validity.vortex_ring);
}

// step() must come to rest where steady() is: that is the balance which the references check.
TEST(Rotor, StepSettlesWhereSteadyIs) {
  struct Case {
    double rpm, vx, vy, vz, p, q;
  };
  for (const Case& k :
       {Case{4000, 0, 0, 0, 0, 0}, Case{5500, 0, 0, -4, 0, 0}, Case{4500, 0, 0, 3, 0, 0},
        Case{4500, 0, 0, 14, 0, 0}, Case{4500, 5, 0, 0, 0, 0}, Case{4500, 9, -9, -2, 0, 0},
        Case{5000, 3, 1, 1, 2, -1}, Case{3000, 11, 0, -1, 0, 3}}) {
    RotorConditions c = hover(k.rpm);
    c.v_AP_P_mps = {k.vx, k.vy, k.vz};
    c.w_WP_P_radps = {k.p, k.q, 0.0};
    Rotor rotor(hobbyking(), -1);
    const RotorLoads got = settled(rotor, c, 2.0);
    const RotorLoads want = rotor.steady(c);
    const Tolerance small = stated(2e-5 * std::abs(want.thrust_N), "two seconds of settling");
    EXPECT_FALSE(want.validity.not_converged);
    EXPECT_TRUE(near((got.f_P_N - want.f_P_N).norm(), 0.0, small)) << k.rpm << " " << k.vz;
    EXPECT_TRUE(near((got.tau_P_Nm - want.tau_P_Nm).norm(), 0.0, small)) << k.rpm << " " << k.vz;
  }
}

TEST(Rotor, ThrustOvershootsWhenSpeedStepsUp) {
  Rotor rotor(hobbyking(), 1);
  settled(rotor, hover(4000.0));
  const double first = rotor.step(hover(5000.0), 1e-3).thrust_N;
  const double last = settled(rotor, hover(5000.0)).thrust_N;
  EXPECT_GT(first, 1.05 * last);  // the inflow of 4000 rpm is still there
}

// Pitt and Peters: with the blade's own damping the inflow settles faster than by momentum alone,
// 0.849 R / (4 u); both in the range of milliseconds for this rotor.
TEST(Rotor, InflowSettlesWithinItsApparentMass) {
  Rotor rotor(hobbyking(), 1);
  settled(rotor, hover(4000.0));
  const double before = rotor.steady(hover(4000.0)).induced_velocity_mps;
  const double after = rotor.steady(hover(4100.0)).induced_velocity_mps;
  const double by_momentum_s = 0.849 * 0.127 / (4.0 * before);
  double t = 0.0;
  while (rotor.step(hover(4100.0), 1e-5).induced_velocity_mps <
         before + (1.0 - std::exp(-1.0)) * (after - before)) {
    t += 1e-5;
    ASSERT_LT(t, 0.1);
  }
  EXPECT_LT(t, by_momentum_s);
  EXPECT_GT(t, 0.2 * by_momentum_s);
}

TEST(Rotor, HalvingTheStepHalvesItsError) {
  const auto after_10ms = [](int steps) {
    Rotor rotor(hobbyking(), 1);
    settled(rotor, hover(4000.0));
    for (int i = 0; i < steps; ++i) rotor.step(hover(4600.0), 0.010 / steps);
    return rotor.step(hover(4600.0), 1e-9).thrust_N;
  };
  const double exact = after_10ms(2560);
  const double ratio = (after_10ms(20) - exact) / (after_10ms(40) - exact);
  EXPECT_GT(ratio, 1.8);
  EXPECT_LT(ratio, 2.2);
}

// Small rotors at a constant speed were found to gain what [CheesemanBennett] says, 1/(1 - (R/4z)^2)
// [SanchezCuevas, fig. 3]; helicopters at a constant thrust to save more, which is what the model has
// [Hayden].
TEST(Rotor, GroundCarries) {
  const Rotor rotor(hobbyking(), 1);
  const RotorLoads free = rotor.steady(hover(4500.0));
  double last = free.thrust_N;
  for (const double heights : {4.0, 2.0, 1.5, 1.0, 0.7, 0.5, 0.3}) {
    RotorConditions c = hover(4500.0);
    c.height_m = heights * 0.127;
    const RotorLoads loads = rotor.steady(c);
    EXPECT_GT(loads.thrust_N, last) << heights;
    const double gain = 1.0 / (1.0 - std::pow(0.25 / heights, 2));
    if (heights >= 0.7) {
      EXPECT_TRUE(near(loads.thrust_N / free.thrust_N, gain, stated(0.03, "scatter of the figure")))
          << heights;
    }
    // The same thrust out of ground effect costs more power.
    const double same_FM = std::pow(loads.thrust_N / free.thrust_N, 1.5) * free.shaft_power_W;
    EXPECT_LT(loads.shaft_power_W, same_FM) << heights;
    last = loads.thrust_N;
  }
}

// Forward flight blows the disc back, whichever way it turns; the lift of all blades cones it.
TEST(Rotor, FlapsBackInForwardFlight) {
  for (const int spin : {1, -1}) {
    const Rotor rotor(hobbyking(), spin);
    RotorConditions c = hover(4500.0);
    EXPECT_GT(rotor.steady(c).flap_rad.x(), 0.0);
    EXPECT_TRUE(near(rotor.steady(c).flap_rad.tail<2>().norm(), 0.0, stated(1e-6, "solver")));
    c.v_AP_P_mps.x() = 5.0;
    EXPECT_GT(rotor.steady(c).flap_rad.y(), 1e-4);
  }
}

Eigen::Vector3d flap_rad(int spin, const Eigen::Vector3d& v_mps, const Eigen::Vector3d& w_radps) {
  RotorConditions c = hover(4500.0);
  c.v_AP_P_mps = v_mps;
  c.w_WP_P_radps = w_radps;
  return Rotor(hobbyking(), spin).steady(c).flap_rad;
}

// A stiff blade answers in phase: it stands highest where it meets the most air. From ahead a rotor that turns
// counter-clockwise meets it on its right.
TEST(Rotor, FlapsUpOnItsAdvancingSide) {
  for (const int spin : {1, -1}) EXPECT_GT(spin * flap_rad(spin, {5, 0, 0}, {0, 0, 0}).z(), 1e-4);
}

// Blown from the right it does to the right what it did ahead: forward, right, backward are one cycle.
TEST(Rotor, FlapsAsTheWindTurns) {
  for (const int spin : {1, -1}) {
    const Eigen::Vector3d ahead = flap_rad(spin, {5, 0, 0}, {0, 0, 0});
    const Eigen::Vector3d right = flap_rad(spin, {0, 5, 0}, {0, 0, 0});
    const Tolerance solver = stated(1e-6, "solver");
    EXPECT_TRUE(near(right.x(), ahead.x(), solver));
    EXPECT_TRUE(near(right.y(), -ahead.z(), solver));
    EXPECT_TRUE(near(right.z(), ahead.y(), solver));
  }
}

// Rolled to the right, a counter-clockwise rotor dips ahead, pitched up it dips on the right: each blade
// lags behind the plane that is turned under it. Clockwise it is the other way about.
TEST(Rotor, FlapsAgainstTheTurningOfItsPlane) {
  for (const int spin : {1, -1}) {
    EXPECT_LT(spin * flap_rad(spin, {0, 0, 0}, {3, 0, 0}).y(), -1e-5);
    EXPECT_LT(spin * flap_rad(spin, {0, 0, 0}, {0, 3, 0}).z(), -1e-5);
  }
}

TEST(Rotor, AtRestInStillAirNothingPulls) {
  const RotorLoads loads = Rotor(hobbyking(), 1).steady(RotorConditions{});
  EXPECT_EQ(loads.f_P_N.norm(), 0.0);
  EXPECT_EQ(loads.tau_P_Nm.norm(), 0.0);
}

}  // namespace
}  // namespace whirl::plant

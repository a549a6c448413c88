// The rotor in oblique flow and on a turning body: signs, symmetries and closed forms.
#include "base/near.hpp"
#include "plant/rotor/ring_loads.hpp"
#include "plant/rotor/tests/test_blades.hpp"
#include "plant/rotor/wake_bound.hpp"

namespace whirl::plant {
namespace {

RotorConditions forward(double vx, double rpm = 4500.0) {
  RotorConditions c = hover(rpm);
  c.v_AP_P_mps.x() = vx;
  return c;
}

TEST(Oblique, DragOpposesTheMotionAndGrowsWithIt) {
  const Rotor rotor(hobbyking(), 1);
  double last = 0.0;
  for (const double v : {1.0, 2.0, 4.0, 8.0}) {
    const double drag = -rotor.steady(forward(v)).f_P_N.x();
    EXPECT_GT(drag, last) << v;
    last = drag;
  }
  EXPECT_GT(rotor.steady(forward(-4.0)).f_P_N.x(), 0.0);
}

// [Bangura2017, 4.4]: 0.04 s/m, +- 0.0035, of thrust and speed. The blades give a sixth of it; what the HP quad's
// file adds by hand (0.033) makes it up.
TEST(Oblique, TheBladesGiveASixthOfTheMeasuredDrag) {
  constexpr double kSet_by_hand_spm = 0.033;
  for (const double v : {1.0, 2.0, 5.0}) {
    const RotorLoads l = Rotor(hobbyking(), 1).steady(forward(v, 3950.0));
    const double blades_spm = -l.f_P_N.x() / (l.thrust_N * v);
    EXPECT_TRUE(near(blades_spm, 0.006, stated(0.001, "of the speeds"))) << v;
    EXPECT_TRUE(near(blades_spm + kSet_by_hand_spm, 0.04, stated(0.0035, "of the flights"))) << v;
  }
}

// Of the HP quad: rotors 50 cm apart along the way, hover at 3950 rpm. What the flight leaves out at most.
TEST(WakeBound, ARearRotorLosesNextToNothingAtWhatPlansFlyAndATwentiethAtTenMetresPerSecond) {
  const Rotor rotor(hobbyking(), 1);
  const double hover_N = rotor.steady(hover(3950.0)).thrust_N;
  const double area_m2 = 3.14159265358979323846 * 0.127 * 0.127;
  const double hover_mps = std::sqrt(hover_N / (2.0 * 1.225 * area_m2));
  const auto lost_share = [&](double speed_mps) {
    RotorConditions c = forward(speed_mps, 3950.0);
    const double alone_N = rotor.steady(c).thrust_N;
    c.v_AP_P_mps.z() = -wake_inflow_bound_mps(hover_mps, speed_mps, 0.5, 0.127);
    return 1.0 - rotor.steady(c).thrust_N / alone_N;
  };
  EXPECT_EQ(lost_share(0.0), 0.0);
  EXPECT_TRUE(near(lost_share(2.0), 0.003, stated(0.002, "snapshot; a third of a percent")));
  EXPECT_TRUE(near(lost_share(5.0), 0.02, stated(0.008, "snapshot; two percent")));
  EXPECT_TRUE(near(lost_share(10.0), 0.05, stated(0.015, "snapshot; a twentieth")));
}

// In hover u = vh; at high speed u V = vh^2. Far downstream of a slow rotor nothing of the sheet is left.
TEST(WakeBound, HasTheLimitsOfMomentumTheoryAndOfTheSheet) {
  EXPECT_TRUE(near(forward_induced_mps(4.0, 0.0), 4.0, round_off(4, 4.0)));
  EXPECT_TRUE(near(forward_induced_mps(4.0, 80.0) * 80.0, 16.0, stated(0.01, "(vh/V)^4")));
  EXPECT_LT(wake_inflow_bound_mps(4.0, 0.1, 0.5, 0.127), 1e-3);
  const double fast = forward_induced_mps(4.0, 200.0);
  EXPECT_TRUE(near(wake_inflow_bound_mps(4.0, 200.0, 0.5, 0.127), 2.0 * fast,
                   stated(0.01 * fast, "the sheet has hardly sunk")));
}

TEST(Oblique, AdvancingSideOfACounterclockwiseRotorIsItsRight) {
  const RotorLoads ccw = Rotor(hobbyking(), 1).steady(forward(5.0));
  const RotorLoads cw = Rotor(hobbyking(), -1).steady(forward(5.0));
  EXPECT_LT(ccw.tau_P_Nm.x(), 0.0);  // more lift on the right rolls it to the left
  EXPECT_GT(cw.tau_P_Nm.x(), 0.0);
}

TEST(Oblique, MirroredRotorGivesMirroredLoads) {
  RotorConditions c = forward(4.0);
  c.v_AP_P_mps = {4.0, 1.5, -0.5};
  c.w_WP_P_radps = {0.8, -0.6, 0.3};
  const RotorLoads a = Rotor(hobbyking(), 1).steady(c);
  c.v_AP_P_mps.y() *= -1.0;
  c.w_WP_P_radps.x() *= -1.0;
  c.w_WP_P_radps.z() *= -1.0;
  const RotorLoads b = Rotor(hobbyking(), -1).steady(c);
  const Tolerance small = stated(1e-6 * a.thrust_N, "two separate iterations");
  EXPECT_TRUE(near(a.f_P_N.x(), b.f_P_N.x(), small));
  EXPECT_TRUE(near(a.f_P_N.y(), -b.f_P_N.y(), small));
  EXPECT_TRUE(near(a.f_P_N.z(), b.f_P_N.z(), small));
  EXPECT_TRUE(near(a.tau_P_Nm.x(), -b.tau_P_Nm.x(), small));
  EXPECT_TRUE(near(a.tau_P_Nm.y(), b.tau_P_Nm.y(), small));
  EXPECT_TRUE(near(a.tau_P_Nm.z(), -b.tau_P_Nm.z(), small));
}

// Twelve azimuths: a turn of the wind by 60 deg must turn the loads by 60 deg and nothing else.
TEST(Oblique, NoDirectionIsPreferred) {
  const Rotor rotor(hobbyking(), 1);
  const RotorLoads a = rotor.steady(forward(6.0));
  RotorConditions c = forward(0.0);
  c.v_AP_P_mps = {3.0, 6.0 * std::sqrt(0.75), 0.0};
  const RotorLoads b = rotor.steady(c);
  const double C = 0.5, S = std::sqrt(0.75);
  const Tolerance small = stated(1e-6 * a.thrust_N, "two separate iterations");
  EXPECT_TRUE(near(b.f_P_N.x(), C * a.f_P_N.x() - S * a.f_P_N.y(), small));
  EXPECT_TRUE(near(b.f_P_N.y(), S * a.f_P_N.x() + C * a.f_P_N.y(), small));
  EXPECT_TRUE(near(b.tau_P_Nm.x(), C * a.tau_P_Nm.x() - S * a.tau_P_Nm.y(), small));
}

TEST(Oblique, BodyRatesAreDamped) {
  const Rotor rotor(hobbyking(), 1);
  RotorConditions c = hover(4500.0);
  c.w_WP_P_radps = {2.0, 0.0, 0.0};
  EXPECT_LT(rotor.steady(c).tau_P_Nm.x(), 0.0);
  c.w_WP_P_radps = {0.0, 2.0, 0.0};
  EXPECT_LT(rotor.steady(c).tau_P_Nm.y(), 0.0);
}

TEST(Oblique, ForwardFlightSavesInducedPower) {
  const Rotor rotor(hobbyking(), 1);
  const RotorLoads still = rotor.steady(forward(0.0));
  const RotorLoads fast = rotor.steady(forward(8.0));
  EXPECT_LT(fast.induced_velocity_mps, 0.9 * still.induced_velocity_mps);
  EXPECT_GT(fast.thrust_N, still.thrust_N);
}

TEST(Oblique, BeyondAdvanceRatioIsSaid) {
  const Rotor rotor(hobbyking(), 1);
  const double tip_mps = hover(4500.0).omega_radps * 0.127;
  EXPECT_FALSE(rotor.steady(forward(0.29 * tip_mps)).validity.beyond_advance_ratio);
  EXPECT_TRUE(rotor.steady(forward(0.31 * tip_mps)).validity.beyond_advance_ratio);
}

// The near-ideal blade: every element loaded as the one at the tip, small angles, straight lift line,
// cd = cd0 + K cl^2. Thrust: [Bangura2017, eq. 4.75a]. Drag of the disc and torque: the same
// integrals done by hand (the printed 4.75b, c are garbled), H >= 0.
struct NearIdeal {
  static constexpr double R = 0.127, chord = 0.012, theta = 0.09, lambda = 0.05, omega = 500.0;
  static constexpr double rho = 1.225;
  StraightSection s{0.1, 5.7, 0.012, 0.02};

  RingLoads numeric(double mu, double coning_rad = 0.0) const {
    PropellerDescription d;
    d.diameter_m = 2.0 * R;
    d.mass_kg = 0.01;
    d.stall_delay = false;
    d.stations = {{0.15, chord / R, theta}, {0.5, chord / R, theta}, {1.0, chord / R, theta}};
    d.sections = {{0.2, s.family()}};
    Ring ring = make_blade(d).value()->rings[0];
    ring.r_m = R;
    ring.dr_m = R;
    DiscFlow f;
    f.omega_radps = omega;
    f.vx_mps = mu * omega * R;
    f.climb_mps = lambda * omega * R;
    f.tip_radius_m = R;
    f.blade_count = 2;
    f.flap_rad.mean = coning_rad;
    RingLoads loads;
    ring_loads(ring, f, 0.0, 0.0, loads);
    return loads;
  }
};

TEST(Oblique, NearIdealBladeMeetsItsClosedForms) {
  const NearIdeal n;
  const double unit = 0.25 * 2 * n.rho * n.chord * std::pow(n.R, 3) * n.omega * n.omega;
  for (const double mu : {0.0, 0.05, 0.1, 0.15}) {
    const RingLoads got = n.numeric(mu);
    const double thrust = unit * (n.s.cl0 * (2.0 + mu * mu) +
                                  n.s.slope * (n.theta * (2.0 + mu * mu) - 2.0 * n.lambda));
    const double a = n.s.cl0 + n.s.slope * n.theta;  // cl (1 + mu s) = a (1 + mu s) - b lambda
    const double b = n.s.slope;
    const double drag =
        2.0 * unit * mu * (n.s.cd0 + n.s.K * a * (a - b * n.lambda) + 0.5 * n.lambda * a);
    const double cl2 =
        a * a * (1.0 + 0.5 * mu * mu) - 2.0 * a * b * n.lambda + std::pow(b * n.lambda, 2);
    const double torque =
        2.0 * unit * n.R *
        (n.s.cd0 * (1.0 + 0.5 * mu * mu) + n.s.K * cl2 + n.lambda * (a - b * n.lambda));
    const auto two_percent = [](double x) {
      return stated(0.02 * std::abs(x) + 1e-9,
                    "small angles: phi^2/2 and cd phi against cl, phi < 0.06");
    };
    EXPECT_TRUE(near(got.thrust_N, thrust, two_percent(thrust))) << mu;
    EXPECT_TRUE(near(-got.fx_N, drag, two_percent(drag))) << mu;
    EXPECT_TRUE(near(got.drive_N * n.R, torque, two_percent(torque))) << mu;
  }
}

// Seen from a coned blade the wind comes from below in front: lift there, by beta V cos(theta).
TEST(Oblique, ConingLiftsTheFrontBlade) {
  const NearIdeal n;
  const double mu = 0.05, beta = 0.03;
  const double want =
      0.25 * n.rho * 2 * n.chord * n.R * n.s.slope * beta * mu * std::pow(n.omega * n.R, 2);
  EXPECT_TRUE(near(n.numeric(mu, beta).lift_N.c, want, stated(0.03 * want, "small angles")));
}

TEST(Oblique, YawingAgainstTheSpinCostsThrust) {
  RotorConditions c = hover(4500.0);
  const double still = Rotor(hobbyking(), 1).steady(c).thrust_N;
  c.w_WP_P_radps.z() = 20.0;  // clockwise seen from above
  EXPECT_LT(Rotor(hobbyking(), 1).steady(c).thrust_N, still);
  EXPECT_GT(Rotor(hobbyking(), -1).steady(c).thrust_N, still);
}

// In hover the inflow's gradient answers a moment L with 2 L / (rho A R u) at the tip [PittPeters];
// a roll rate p acts like a gradient of R p. So the moment of the first instant, before the inflow has
// moved, falls by 1 + 2 k / (rho A R u), k = L / (R p).
TEST(Oblique, InflowTakesItsShareOfTheRollDamping) {
  RotorConditions c = hover(4500.0);
  PropellerDescription d = hobbyking_10x4_5(section("bw3"), section("e63"));
  d.flap_stiffness_Nm_per_rad = 1e5;  // flapping has its own share; not here
  Rotor rotor(make_blade(d).value(), 1);
  for (int i = 0; i < 500; ++i) rotor.step(c, 1e-3);
  c.w_WP_P_radps.x() = 1.0;
  const double at_once = -rotor.step(c, 1e-9).tau_P_Nm.x();
  const RotorLoads later = rotor.steady(c);
  const double R = 0.127;
  const double k = at_once / (R * 1.0);
  const double ratio =
      1.0 + 2.0 * k / (1.225 * 3.14159265 * R * R * R * later.induced_velocity_mps);
  EXPECT_GT(ratio, 1.2);
  EXPECT_TRUE(near(at_once / -later.tau_P_Nm.x(), ratio, stated(0.03 * ratio, "linear in p")));
}

// To turn a rotor that spins counter-clockwise to the right, its shaft must pitch it up; blades that
// bend give way to that, the disc tilts forward and takes the thrust along.
TEST(Oblique, BendingBladesPrecess) {
  const auto force_x = [](double stiffness_Nm_per_rad, int spin) {
    PropellerDescription d = hobbyking_10x4_5(section("bw3"), section("e63"));
    d.flap_stiffness_Nm_per_rad = stiffness_Nm_per_rad;
    RotorConditions c = hover(4500.0);
    c.w_WP_P_radps.x() = 3.0;
    return Rotor(make_blade(d).value(), spin).steady(c).f_P_N.x();
  };
  const double stiff = force_x(1e5, 1);
  EXPECT_GT(force_x(20.0, 1), stiff);
  EXPECT_LT(force_x(20.0, -1), force_x(1e5, -1));
}

// Aft of the shaft the skewed wake blows stronger: the nose comes up by more lift in front.
TEST(Oblique, SkewedWakeLiftsTheNose) {
  EXPECT_GT(Rotor(hobbyking(), 1).steady(forward(3.0)).tau_P_Nm.y(), 0.0);
  EXPECT_GT(Rotor(hobbyking(), -1).steady(forward(3.0)).tau_P_Nm.y(), 0.0);
}

}  // namespace
}  // namespace whirl::plant

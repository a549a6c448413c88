#include "plant/airframe/rigid_body.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

constexpr double kStep_s = 1e-3;

MassProperties asymmetric() {
  return {0.9, {0.010, 0.016, 0.022}};
}

double energy_J(const BodyState& s, const MassProperties& m) {
  return 0.5 * m.inertia_kgm2.dot(s.w_WB_B_radps.cwiseAbs2());
}

struct Jacobi {
  double sn, cn, dn;
};

// Descending Landen transformation (arithmetic-geometric mean).
Jacobi jacobi(double u, double k2) {
  double a[12] = {1.0}, c[12] = {std::sqrt(k2)}, b = std::sqrt(1.0 - k2);
  int n = 0;
  for (; std::abs(c[n]) > 1e-16 && n < 11; ++n) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
  }
  double phi = std::ldexp(a[n] * u, n);
  for (int i = n; i > 0; --i) phi = 0.5 * (phi + std::asin(c[i] / a[i] * std::sin(phi)));
  const double sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt(1.0 - k2 * sn * sn)};
}

TEST(RigidBody, FreeAsymmetricTopFollowsJacobisFunctions) {  // [Landau1976, 37]
  const MassProperties m = asymmetric();
  const double I1 = m.inertia_kgm2[0], I2 = m.inertia_kgm2[1], I3 = m.inertia_kgm2[2];
  BodyState s;
  s.w_WB_B_radps = {6.0, 0.0, 8.0};
  const double E2 = 2.0 * energy_J(s, m), M2 = I1 * I1 * 36.0 + I3 * I3 * 64.0;
  ASSERT_GT(M2, E2 * I2);
  const double k2 = (I2 - I1) * (E2 * I3 - M2) / ((I3 - I2) * (M2 - E2 * I1));
  const double rate = std::sqrt((I3 - I2) * (M2 - E2 * I1) / (I1 * I2 * I3));
  const double size2 = std::sqrt((E2 * I3 - M2) / (I2 * (I3 - I2)));
  double worst = 0.0;
  for (int k = 1; k <= 10000; ++k) {
    s = step_free(s, m, {}, kStep_s);
    const Jacobi f = jacobi(rate * k * kStep_s, k2);
    const Vector3d want(6.0 * f.cn, size2 * f.sn, 8.0 * f.dn);
    worst = std::max(worst, (s.w_WB_B_radps - want).norm());
  }
  EXPECT_TRUE(near(worst, 0.0, stated(1e-6 * 10.0, "1e-6 of the rate over 10 s")));
  RecordProperty("worst_radps", std::to_string(worst));
}

TEST(RigidBody, TumblingKeepsEnergyAndMomentum) {
  const MassProperties m = asymmetric();
  BodyState s;
  s.w_WB_B_radps = {0.01, 12.0, 0.02};  // about the unstable axis: flips over and over
  const double E0 = energy_J(s, m);
  const Vector3d L0 = angular_momentum_W(s, m, Vector3d::Zero());
  double worst_E = 0.0, worst_L = 0.0;
  for (int k = 0; k < 10000; ++k) {
    s = step_free(s, m, {}, kStep_s);
    worst_E = std::max(worst_E, std::abs(energy_J(s, m) - E0) / E0);
    const Vector3d L = angular_momentum_W(s, m, Vector3d::Zero());
    worst_L = std::max(worst_L, (L - L0).norm() / L0.norm());
  }
  EXPECT_TRUE(near(worst_E, 0.0, stated(1e-6, "issue")));
  EXPECT_TRUE(near(worst_L, 0.0, stated(1e-11, "round-off of 10,000 steps")));
}

TEST(RigidBody, AttitudeIsOfFourthOrder) {
  auto attitude_after_1s = [](int steps) {
    BodyState s;
    s.w_WB_B_radps = {6.0, 1.0, 8.0};
    for (int k = 0; k < steps; ++k) s = step_free(s, asymmetric(), {}, 1.0 / steps);
    return s.q_WB;
  };
  const auto exact = attitude_after_1s(20000);
  const double coarse = attitude_after_1s(100).angularDistance(exact);
  const double fine = attitude_after_1s(200).angularDistance(exact);
  EXPECT_TRUE(near(coarse / fine, 16.0, stated(2.5, "fourth order")));
}

// An oblate top's transverse rate turns in the body at (I3 - I1) w3 / I1, in the sense of the spin.
TEST(RigidBody, OblateTopPrecessesInTheSenseOfItsSpin) {
  const MassProperties m{1.0, {2.0, 2.0, 3.0}};
  BodyState s;
  s.w_WB_B_radps = {1.0, 0.0, 4.0};
  const Vector3d alpha = angular_acceleration_B(s, m, {}, kStep_s);
  EXPECT_TRUE(near((alpha - Vector3d(0.0, 2.0, 0.0)).norm(), 0.0, round_off(8, 2.0)));
}

// A rotor along -z (counter-clockwise from above) under a pitching body rate: torque -w x h.
TEST(RigidBody, SpinningRotorTurnsPitchRateIntoRoll) {
  const MassProperties m{1.0, {0.01, 0.01, 0.02}};
  BodyState s;
  s.w_WB_B_radps = {0.0, 2.0, 0.0};
  Forcing f;
  f.spin_start_B_Nms = f.spin_end_B_Nms = {0.0, 0.0, -0.016};
  const Vector3d alpha = angular_acceleration_B(s, m, f, kStep_s);
  EXPECT_TRUE(near(alpha.x(), 2.0 * 0.016 / 0.01, round_off(8, 3.2)));
}

TEST(RigidBody, RotorThatSpinsUpTurnsTheBodyTheOtherWay) {
  const MassProperties m{1.0, {0.01, 0.01, 0.02}};
  Forcing f;
  f.spin_end_B_Nms = {0.0, 0.0, -0.016};
  const BodyState s = step_free({}, m, f, kStep_s);
  EXPECT_TRUE(near(s.w_WB_B_radps.z(), 0.016 / 0.02, round_off(20, 0.8)));
  const Vector3d alpha = angular_acceleration_B({}, m, f, kStep_s);
  EXPECT_TRUE(near(alpha.z(), 0.016 / 0.02 / kStep_s, round_off(20, 800.0)));
}

TEST(RigidBody, ConstantTorqueGivesItsAngularMomentum) {
  const MassProperties m{1.0, {0.01, 0.01, 0.02}};
  Forcing f;
  f.tau_B_Nm = {0.0, 0.0, 0.1};
  BodyState s;
  for (int k = 0; k < 1000; ++k) s = step_free(s, m, f, kStep_s);
  EXPECT_TRUE(near(s.w_WB_B_radps.z(), 5.0, round_off(1000, 5.0)));
  EXPECT_TRUE(near(Eigen::AngleAxisd(s.q_WB).angle(), 2.5, stated(1e-9, "half a t^2")));
}

TEST(RigidBody, FallsAsHalfGTimesTimeSquared) {
  BodyState s;
  for (int k = 0; k < 2000; ++k) s = step_free(s, asymmetric(), {}, kStep_s);
  EXPECT_TRUE(near(s.p_WB_W_m.z(), 0.5 * 9.80665 * 4.0, round_off(4000, 20.0)));
}

TEST(RigidBody, BodyForceTurnsWithTheBodyAndWorldForceDoesNot) {
  Forcing f;
  f.f_B_N = {0.9, 0.0, 0.0};
  BodyState s;
  s.q_WB = Eigen::AngleAxisd(M_PI / 2.0, Vector3d::UnitZ());
  EXPECT_TRUE(near(step_free(s, asymmetric(), f, 1.0).v_WB_W_mps.y(), 1.0, round_off(8, 1.0)));
  f = {};
  f.f_W_N = {0.9, 0.0, 0.0};
  EXPECT_TRUE(near(step_free(s, asymmetric(), f, 1.0).v_WB_W_mps.x(), 1.0, round_off(8, 1.0)));
}

}  // namespace
}  // namespace whirl::plant

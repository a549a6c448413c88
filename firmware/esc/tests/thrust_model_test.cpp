#include "firmware/esc/core/thrust_model.hpp"

#include <cmath>

#include "base/near.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;

// A near-ideal rotor by its definitions [Bangura 2017, sec. 5.3.1]: 2 blades, R = 0.1 m effective,
// tip chord 12 mm, Cla = 5.5, Cd0 = 0.03, rho = 1.2; kappa constant.
ThrustModel near_ideal(float tip_pitch_rad = 0.2f, float kappa = 1.3f) {
  const float rho = 1.2f, R = 0.1f, c = 0.012f, area = 3.14159265f * R * R;
  return {.c0 = R,
          .c1 = 0.5f * 2 * rho * c * R * R * R * 5.5f,
          .c2 = tip_pitch_rad,
          .c3 = 0.5f * rho * c * 2 * 0.03f * R * R * R * R,
          .c4 = 2 * rho * area * R * R,
          .d0 = kappa,
          .d1 = 0.0f};
}

TEST(ThrustModel, HoverThrustBalancesMomentumAndBladeElement) {
  const ThrustModel m = near_ideal();
  const RotorPoint hover = at_inflow(m, 0.0f);
  ASSERT_TRUE(hover.real);
  EXPECT_TRUE(near(hover.CT, m.c4 * hover.li * hover.li, stated(1e-5 * hover.CT, "float root")));
  EXPECT_TRUE(near(hover.CT, m.c1 * (m.c2 - hover.li), stated(1e-6 * hover.CT, "float")));
}

TEST(ThrustModel, DowndraftTakesThrustAndRaisesInflow) {
  const ThrustModel m = near_ideal();
  const RotorPoint hover = at_inflow(m, 0.0f), down = at_inflow(m, 0.05f);
  EXPECT_LT(down.CT, hover.CT);
  EXPECT_LT(down.li, hover.li);
  EXPECT_GT(down.li + 0.05f, hover.li);
}

TEST(ThrustSolver, InvertsTheModelWhereverPowerDeterminesInflow) {
  const ThrustModel m = near_ideal();
  ThrustSolver solver(m);
  int solved = 0;
  for (float ls = solver.turning_inflow() + 0.01f; ls < 0.12f; ls += 0.001f) {
    const RotorPoint truth = at_inflow(m, ls);
    const ThrustEstimate found = solver.solve(truth.CP);
    if (found.status == Estimate::not_observable) continue;
    ASSERT_EQ(found.status, Estimate::converged) << ls;
    EXPECT_LE(found.iterations, 6) << ls;
    EXPECT_GT(found.leverage, 0.0f) << "downdraft takes both thrust and power: " << ls;
    EXPECT_TRUE(near(found.CT, truth.CT, stated(2e-3 * truth.CT, "CP tolerance over its slope")));
    ++solved;
  }
  EXPECT_GT(solved, 20);
}

TEST(ThrustSolver, SaysSoWhereTwoInflowsShareOnePower) {
  // Without induced losses CP - c3 = c0 CT lambda, which is largest at lambda = c2 / 2: for a coarse
  // pitch that lies beyond hover, and power rises with inflow before it falls.
  const ThrustModel m = near_ideal(0.4f, 1.0f);
  ThrustSolver solver(m);
  ASSERT_GT(solver.turning_inflow(), 0.0f) << "this rotor's power must have a maximum for the test";
  const float ls = solver.turning_inflow();
  EXPECT_TRUE(near(at_inflow(m, ls).li + ls, 0.2, stated(0.008, "cells of the table")));
  const float CP = at_inflow(m, 0.0f).CP;
  EXPECT_EQ(solver.solve(CP).status, Estimate::not_observable);
  const float above_all = 1.05f * at_inflow(m, solver.turning_inflow()).CP;
  EXPECT_EQ(solver.solve(above_all).status, Estimate::not_observable);
}

TEST(ThrustSolver, RefusesPowerBelowTheModelAndNotANumber) {
  ThrustSolver solver(near_ideal());
  EXPECT_EQ(solver.solve(0.0f).status, Estimate::out_of_model);
  EXPECT_EQ(solver.solve(-1.0f).status, Estimate::out_of_model);
  EXPECT_EQ(solver.solve(std::nanf("")).status, Estimate::out_of_model);
}

TEST(ThrustSolver, FollowsAJumpFromAnyStart) {
  const ThrustModel m = near_ideal();
  for (float start : {-0.007f, 0.0f, 0.05f, 0.155f}) {
    ThrustSolver solver(m);
    solver.solve(at_inflow(m, start).CP);
    const RotorPoint truth = at_inflow(m, 0.11f);
    const ThrustEstimate found = solver.solve(truth.CP);
    ASSERT_EQ(found.status, Estimate::converged);
    EXPECT_LE(found.iterations, 6);
    EXPECT_TRUE(near(found.CT, truth.CT, stated(2e-3 * truth.CT, "CP tolerance over its slope")));
  }
}

}  // namespace
}  // namespace fw::esc

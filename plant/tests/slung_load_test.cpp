#include "plant/airframe/slung_load.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/near.hpp"
#include "plant/base/frames.hpp"
#include "plant/tests/quadratic_rotor.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

constexpr double kStep_s = 1e-3, kLoad_kg = 0.2;

struct Pair {  // a free body with a load, and what holds the body up
  MassProperties mass;
  SlungLoad load;
  BodyState body;
  Vector3d lift_W_N = Vector3d::Zero();

  explicit Pair(const Vector3d& attach_B_m = Vector3d::Zero(), double body_kg = 0.9)
      : mass{body_kg, {0.0125, 0.0125, 0.0235}},
        load({.mass_kg = kLoad_kg, .line_m = 1.0, .attach_B_m = attach_B_m}, mass) {
    body.p_WB_W_m.z() = -50.0;
    load.hang(body);
  }
  void step() {
    Forcing forcing;
    forcing.f_W_N = lift_W_N;
    load.step(body, forcing, 1.225, Vector3d::Zero(), kStep_s);
    body = step_free(body, mass, forcing, kStep_s);
  }
  Vector3d momentum() const { return mass.mass_kg * body.v_WB_W_mps + kLoad_kg * load.v_W_mps(); }
};

TEST(SlungLoad, HangsWithItsWeightOnTheLine) {
  Pair pair;
  pair.lift_W_N.z() = -(0.9 + kLoad_kg) * kGravity_mps2;
  for (int k = 0; k < 2000; ++k) pair.step();
  EXPECT_TRUE(near(pair.load.tension_N(), kLoad_kg * kGravity_mps2, stated(1e-6, "at rest")));
  EXPECT_TRUE(near(pair.load.p_W_m().z(), pair.body.p_WB_W_m.z() + 1.0, stated(1e-6, "taut")));
}

TEST(SlungLoad, AFeatherIsCaughtByTheAirAndNotThrownBack) {
  const MassProperties mass{0.9, {0.0125, 0.0125, 0.0235}};
  SlungLoad feather({.mass_kg = 1e-3, .line_m = 100.0, .drag_area_m2 = 10.0}, mass);
  BodyState body;
  body.p_WB_W_m.z() = -200.0;
  body.v_WB_W_mps.x() = 100.0;
  feather.hang(body);
  for (int k = 0; k < 100; ++k) {
    Forcing forcing;
    feather.step(body, forcing, 1.225, Vector3d::Zero(), kStep_s);
    EXPECT_LE(feather.v_W_mps().norm(), 100.0);
  }
  EXPECT_LT(feather.v_W_mps().norm(), 0.1);
}

TEST(SlungLoad, SwingsAsAPendulum) {
  Pair pair(Vector3d::Zero(), 1e6);  // as good as fixed
  pair.lift_W_N.z() = -1e6 * kGravity_mps2;
  for (int k = 0; k < 10; ++k) pair.step();
  // A push of the pivot, seen from the pivot: the load lags.
  pair.body.v_WB_W_mps.x() = 0.1;
  double before = 0.0, first_s = 0.0, last_s = 0.0;
  int crossings = 0;
  for (int k = 0; k < 20000; ++k) {
    pair.step();
    const double off_m = pair.load.p_W_m().x() - pair.body.p_WB_W_m.x();
    if (before < 0.0 && off_m >= 0.0) {
      const double t_s = (k + before / (before - off_m)) * kStep_s;
      if (crossings++ == 0) first_s = t_s;
      last_s = t_s;
    }
    before = off_m;
  }
  const double want_s = 2.0 * M_PI * std::sqrt(1.0 / kGravity_mps2);
  EXPECT_TRUE(
      near((last_s - first_s) / (crossings - 1), want_s, stated(1e-3 * want_s, "0.03 rad")));
}

// Whatever the line does, it is between the two.
TEST(SlungLoad, TheLineKeepsTheMomentumOfBoth) {
  Pair pair({0.05, 0.0, 0.04});
  pair.body.v_WB_W_mps = {1.0, -2.0, -3.0};  // away from the load: it snatches
  const Vector3d before = pair.momentum();
  double tightest_N = 0.0;
  for (int k = 0; k < 500; ++k) {
    pair.step();
    tightest_N = std::max(tightest_N, pair.load.tension_N());
  }
  EXPECT_GT(tightest_N, 5.0);
  const Vector3d want = before + Vector3d(0.0, 0.0, 0.5 * kGravity_mps2 * (0.9 + kLoad_kg));
  EXPECT_TRUE(near((pair.momentum() - want).norm(), 0.0, round_off(5000, 10.0)));
}

TEST(SlungLoad, ASlackLineDoesNotPush) {
  Pair pair;
  pair.body.v_WB_W_mps.z() = 1.0;  // down, towards the load
  for (int k = 0; k < 300; ++k) {
    pair.step();
    ASSERT_EQ(pair.load.tension_N(), 0.0) << k;
  }
}

TEST(SlungLoad, ASwingGainsNoEnergy) {
  Pair pair({0.0, 0.0, 0.05});
  pair.body.v_WB_W_mps = {2.0, 0.0, 0.0};
  const auto energy_J = [&] {
    const Vector3d& w = pair.body.w_WB_B_radps;
    return 0.5 * 0.9 * pair.body.v_WB_W_mps.squaredNorm() +
           0.5 * w.dot(pair.mass.inertia_kgm2.cwiseProduct(w)) +
           0.5 * kLoad_kg * pair.load.v_W_mps().squaredNorm() -
           kGravity_mps2 * (0.9 * pair.body.p_WB_W_m.z() + kLoad_kg * pair.load.p_W_m().z());
  };
  const double before_J = energy_J();
  for (int k = 0; k < 3000; ++k) pair.step();  // they whirl about each other as they fall
  EXPECT_LT(energy_J(), before_J + 1e-3 * 0.5 * 0.9 * 4.0);
}

TEST(SlungLoad, OnTheFloorItRestsAndTheLineIsSlack) {
  VehicleParams params = hp_quad();
  params.load = SlungLoadParams{.mass_kg = kLoad_kg, .line_m = 1.0};
  Vehicle v(params, quadratic_rotors(params.airframe), 1);
  for (int k = 0; k < 500; ++k) v.step(kStep_s);
  EXPECT_EQ(v.state().load_p_W_m.z(), 0.0);
  EXPECT_EQ(v.state().line_tension_N, 0.0);
  EXPECT_TRUE(v.state().on_ground);
}

TEST(SlungLoad, AVehicleThatClimbsTakesItsLoadAlong) {
  VehicleParams params = hp_quad();
  params.load = SlungLoadParams{.mass_kg = kLoad_kg, .line_m = 1.0};
  Vehicle v(params, quadratic_rotors(params.airframe), 1);
  v.place({0, 0, -20}, Eigen::Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero());
  for (int i = 0; i < 4; ++i) {
    v.set_motor_speed(i, 450.0);
    v.command(i, {0.42, Freewheel::synchronous});
  }
  for (int k = 0; k < 1000; ++k) v.step(kStep_s);
  const VehicleState& s = v.state();
  EXPECT_TRUE(near(s.load_p_W_m.z() - s.p_WB_W_m.z(), 1.0, stated(1e-3, "taut")));
  EXPECT_GT(s.line_tension_N, 0.0);
  EXPECT_TRUE(near(s.load_v_W_mps.z(), s.v_WB_W_mps.z(), stated(1e-2, "one motion")));
}

}  // namespace
}  // namespace whirl::plant

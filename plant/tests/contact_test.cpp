#include "plant/airframe/contact_world.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;
constexpr double kStep_s = 1e-3, kGear_m = 0.11;

struct Drop {
  AirframeParams frame = hp_quad().airframe;
  BodyState s;
  ContactWorld ground{frame};
  double impulse = 0.0;
  void step(const Forcing& f = {}) {
    const MassProperties m{frame.mass_kg, frame.inertia_kgm2};
    impulse = ground.in_reach(s, kStep_s) ? ground.step(s, f, kStep_s).sum_Ns : 0.0;
    if (impulse == 0.0) s = step_free(s, m, f, kStep_s);
  }
};

TEST(Contact, LevelDropBouncesToRestitutionSquaredTimesItsHeight) {
  Drop drop;
  drop.s.p_WB_W_m.z() = -kGear_m - 1.0;
  bool touched = false;
  double top = 0.0;
  for (int k = 0; k < 700; ++k) {
    drop.step();
    touched |= drop.impulse > 0.0;
    if (touched && k > 500) top = std::max(top, -kGear_m - drop.s.p_WB_W_m.z());
  }
  ASSERT_TRUE(touched);
  EXPECT_TRUE(near(top, 0.3 * 0.3 * 1.0, stated(0.005, "one step of 4.4 m/s is 4.4 mm")));
}

TEST(Contact, TiltedDropComesToRestAndStays) {
  Drop drop;
  drop.s.p_WB_W_m.z() = -0.5;
  drop.s.q_WB = Eigen::AngleAxisd(0.3, Vector3d(1.0, 0.5, 0.0).normalized());
  for (int k = 0; k < 5000; ++k) drop.step();
  const BodyState rested = drop.s;
  double fastest = 0.0;
  for (int k = 0; k < 5000; ++k) {
    drop.step();
    fastest = std::max(fastest, drop.s.v_WB_W_mps.norm() + drop.s.w_WB_B_radps.norm());
  }
  EXPECT_TRUE(near(fastest, 0.0, stated(1e-6, "m/s and rad/s: no jitter")));
  EXPECT_TRUE(near((drop.s.p_WB_W_m - rested.p_WB_W_m).norm(), 0.0, stated(1e-6, "no creep")));
  EXPECT_TRUE(near(drop.s.p_WB_W_m.z(), -kGear_m, stated(1e-3, "Bullet's slop")));
  EXPECT_TRUE(near(drop.impulse, 0.9 * 9.80665 * kStep_s, stated(1e-6, "weight x step")));
}

TEST(Contact, FrictionHoldsASidewaysForceUpToItsCoefficient) {
  for (const auto& [share, slides] : {std::pair{0.7, false}, std::pair{0.9, true}}) {
    Drop drop;
    drop.s.p_WB_W_m.z() = -kGear_m;
    for (int k = 0; k < 500; ++k) drop.step();
    const double from = drop.s.p_WB_W_m.x();
    Forcing f;
    f.f_W_N.x() = share * 0.9 * 9.80665;  // friction coefficient 0.8
    for (int k = 0; k < 300; ++k) drop.step(f);
    EXPECT_EQ(std::abs(drop.s.p_WB_W_m.x() - from) > 0.005, slides) << share;
  }
}

TEST(Contact, LiftAboveWeightLeavesTheGround) {
  Drop drop;
  drop.s.p_WB_W_m.z() = -kGear_m;
  for (int k = 0; k < 500; ++k) drop.step();
  Forcing f;
  f.f_B_N.z() = -1.2 * 0.9 * 9.80665;
  for (int k = 0; k < 1000; ++k) drop.step(f);
  EXPECT_TRUE(near(drop.s.p_WB_W_m.z(), -kGear_m - 0.5 * 0.2 * 9.80665, stated(0.01, "lift-off")));
}

TEST(Contact, NeverSinksIntoTheGroundHoweverItFalls) {
  for (int tilt = 0; tilt < 12; ++tilt) {
    Drop drop;
    drop.s.p_WB_W_m.z() = -1.0;
    drop.s.v_WB_W_mps = {2.0, 0.0, 3.0};
    drop.s.q_WB = Eigen::AngleAxisd(0.52 * tilt, Vector3d(0.6, 0.8, 0.0));
    for (int k = 0; k < 4000; ++k) {
      drop.step();
      ASSERT_LT(drop.s.p_WB_W_m.z(), 0.0);
    }
    EXPECT_LT(drop.s.v_WB_W_mps.norm(), 0.05) << tilt;
  }
}

}  // namespace
}  // namespace whirl::plant

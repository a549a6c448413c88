#include "plant/airframe/obstacle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "plant/airframe/contact_world.hpp"
#include "plant/base/frames.hpp"
#include "plant/tests/quadratic_rotor.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

constexpr double kStep_s = 1e-3, kDeg = M_PI / 180.0;

TEST(Obstacle, DistancesAreThoseOfGeometry) {
  const Tolerance ulps = round_off(8, 5.0);
  const Obstacle hill = slope(1.0, 0.0, 0.0, 10.0 * kDeg);
  EXPECT_TRUE(near(distance_m(hill, {1.0, 3.0, 0.0}), 0.0, ulps));
  EXPECT_TRUE(near(distance_m(hill, {3.0, 0.0, -2.0 * std::tan(10.0 * kDeg)}), 0.0, ulps));
  EXPECT_TRUE(near(distance_m(hill, {3.0, 0.0, -2.0}),
                   2.0 * std::cos(10.0 * kDeg) - 2.0 * std::sin(10.0 * kDeg), ulps));
  EXPECT_TRUE(near(distance_m(wall(2.0, 90.0 * kDeg), {7.0, 1.5, -1.0}), 0.5, ulps));
  EXPECT_TRUE(near(distance_m(ceiling(3.0), {1.0, 1.0, -2.75}), 0.25, ulps));
  const Obstacle table = box(2.0, 0.0, 0.5, {1.0, 2.0, 0.25}, 90.0 * kDeg);  // 2 m along north
  EXPECT_TRUE(near(distance_m(table, {2.9, 0.0, -1.0}), 0.25, ulps));
  EXPECT_TRUE(near(distance_m(table, {2.0, 0.8, -0.6}), 0.3, ulps));
  EXPECT_TRUE(near(distance_m(table, {3.3, 0.9, -0.6}), 0.5, ulps));  // 0.3 and 0.4 off an edge
  EXPECT_TRUE(near(distance_m(table, {2.0, 0.0, -0.6}), -0.1, ulps));
}

TEST(Obstacle, HeightIsAboveTheHighestSurfaceStraightBelow) {
  const std::vector<Obstacle> all{slope(1.0, 0.0, 0.0, 10.0 * kDeg),
                                  box(0.0, 0.0, 0.0, {1.0, 1.0, 0.5}, 0.0), wall(5.0, 0.0),
                                  ceiling(3.0)};
  const Tolerance ulps = round_off(8, 3.0);
  EXPECT_TRUE(near(height_above_m(all, {0.0, 0.0, -2.0}), 1.5, ulps));
  EXPECT_TRUE(near(height_above_m(all, {0.0, 2.0, -2.0}), 2.0, ulps));
  EXPECT_TRUE(near(height_above_m(all, {3.0, 0.0, -2.0}), 2.0 - 2.0 * std::tan(10.0 * kDeg), ulps));
}

TEST(Obstacle, ADiscEntersWhatItsRimReaches) {
  const Obstacle side = wall(1.0, 0.0), roof = ceiling(2.0);
  const Vector3d level(0.0, 0.0, 1.0);
  EXPECT_FALSE(disc_enters(side, {0.87, 0.0, -1.0}, level, 0.127));
  EXPECT_TRUE(disc_enters(side, {0.88, 0.0, -1.0}, level, 0.127));
  EXPECT_FALSE(disc_enters(roof, {0.0, 0.0, -1.99}, level, 0.127));  // flat under it
  const Vector3d tilted(std::sin(30 * kDeg), 0.0, std::cos(30 * kDeg));
  EXPECT_TRUE(disc_enters(roof, {0.0, 0.0, -1.95}, tilted, 0.127));
  const Obstacle crate = box(1.0, 0.0, 0.0, {0.4, 0.4, 1.0}, 0.0);
  EXPECT_TRUE(disc_enters(crate, {0.7, 0.0, -0.5}, level, 0.127));
  EXPECT_FALSE(disc_enters(crate, {0.65, 0.0, -0.5}, level, 0.127));
  EXPECT_FALSE(disc_enters(crate, {0.7, 0.0, -1.1}, level, 0.127));
}

struct Body {
  AirframeParams frame = hp_quad().airframe;
  MassProperties m{frame.mass_kg, frame.inertia_kgm2};
  ContactWorld ground;
  BodyState s;
  Touch touch;

  explicit Body(const std::vector<Obstacle>& obstacles, double friction = 0.8)
      : ground(slippery(friction), obstacles) {}
  AirframeParams slippery(double friction) {
    frame.contact.friction = friction;
    return frame;
  }
  void step(const Forcing& f = {}) {
    touch = ground.in_reach(s, kStep_s) ? ground.step(s, f, kStep_s) : Touch{};
    if (touch.sum_Ns == 0.0) s = step_free(s, m, f, kStep_s);
  }
};

// On its gear along the slope, the centre of mass 11 cm off it.
Body on_slope(double angle_rad, double friction) {
  Body body({slope(-5.0, 0.0, 0.0, angle_rad)}, friction);
  body.s.q_WB = Eigen::AngleAxisd(angle_rad, Vector3d::UnitY());
  const Vector3d up = body.s.q_WB * Vector3d(0.0, 0.0, -1.0);
  body.s.p_WB_W_m = Vector3d(0.0, 0.0, -5.0 * std::tan(angle_rad)) + 0.1105 * up;
  return body;
}

TEST(Obstacle, GearHoldsOnASlopeWhoseTangentIsBelowItsFriction) {
  Body body = on_slope(10.0 * kDeg, 0.8);
  for (int k = 0; k < 1000; ++k) body.step();
  EXPECT_LT(body.s.v_WB_W_mps.norm(), 1e-3);
  EXPECT_LT(body.s.p_WB_W_m.head<2>().norm(), 0.025);
  EXPECT_GT(body.touch.from_below_Ns, 0.0);
}

TEST(Obstacle, GearSlidesDownASlopeWhoseTangentIsAboveItsFriction) {
  Body body = on_slope(20.0 * kDeg, 0.1);
  for (int k = 0; k < 300; ++k) body.step();
  const double before = body.s.v_WB_W_mps.norm();
  for (int k = 0; k < 200; ++k) body.step();
  const double a = (body.s.v_WB_W_mps.norm() - before) / 0.2;
  const double want = kGravity_mps2 * (std::sin(20.0 * kDeg) - 0.1 * std::cos(20.0 * kDeg));
  EXPECT_TRUE(near(a, want, stated(0.1, "the body rocks on its gear")));
  EXPECT_LT(body.s.v_WB_W_mps.x(), 0.0);  // down the hill
}

TEST(Obstacle, ABoxCarriesWhatStandsOnIt) {
  Body body({box(0.0, 0.0, 0.0, {1.0, 1.0, 0.5}, 0.3)});
  body.s.p_WB_W_m = {0.0, 0.0, -0.62};
  for (int k = 0; k < 2000; ++k) body.step();
  EXPECT_TRUE(near(body.s.p_WB_W_m.z(), -0.61, stated(1e-3, "Bullet's slop")));
  EXPECT_TRUE(
      near(body.touch.from_below_Ns, 0.9 * kGravity_mps2 * kStep_s, stated(1e-6, "weight x step")));
}

TEST(Obstacle, AWallGivesBackTheRestitutionsShare) {
  Body body({wall(1.0, 0.0)}, 0.0);
  body.s.p_WB_W_m = {0.5, 0.0, -20.0};
  body.s.v_WB_W_mps = {1.0, 0.0, 0.0};
  double sideways_Ns = 0.0;
  for (int k = 0; k < 500; ++k) {
    body.step();
    sideways_Ns += body.touch.sum_Ns - body.touch.from_below_Ns;
  }
  // The front hub strikes 3 cm above the centre of mass: of the speed there e = 0.3 comes back.
  const double share = 1.0 / (1.0 + 0.9 * 0.03 * 0.03 / 0.0125);
  EXPECT_TRUE(near(sideways_Ns, 0.9 * 1.3 * share, stated(1e-3, "the wall is upright")));
  EXPECT_LT(body.s.v_WB_W_mps.x(), -0.2);
}

TEST(Obstacle, ACeilingStopsTheHubs) {
  Body body({ceiling(3.0)});
  body.s.p_WB_W_m = {0.0, 0.0, -2.9};
  Forcing lift;
  lift.f_W_N.z() = -1.5 * 0.9 * kGravity_mps2;
  for (int k = 0; k < 2000; ++k) body.step(lift);
  // Hubs 3 cm above the centre of mass, 1.5 cm of radius.
  EXPECT_TRUE(near(body.s.p_WB_W_m.z(), -2.955, stated(2e-3, "Bullet's slop")));
  EXPECT_GT(body.touch.sum_Ns, 0.0);
  EXPECT_EQ(body.touch.from_below_Ns, 0.0);
}

TEST(Obstacle, ClearanceIsThatOfTheNearestFootOrHub) {
  const AirframeParams frame = hp_quad().airframe;
  const auto q = Eigen::Quaterniond::Identity();
  const Tolerance ulps = round_off(8, 3.0);
  EXPECT_TRUE(near(clearance_m(frame, {}, {0, 0, -1.0}, q), 0.89, ulps));
  const std::vector<Obstacle> all{wall(1.0, 0.0)};
  EXPECT_TRUE(near(clearance_m(frame, all, {0.5, 0, -1.0}, q), 0.235, ulps));
  EXPECT_LT(clearance_m(frame, all, {0.9, 0, -1.0}, q), 0.0);
}

TEST(Obstacle, APropellerThatStrikesAWallStops) {
  VehicleParams params = hp_quad();
  params.obstacles = {wall(1.0, 0.0)};
  Vehicle v(params, quadratic_rotors(params.airframe), 1);
  v.place({0.6, 0.0, -5.0}, Eigen::Quaterniond::Identity(), {0.5, 0.0, 0.0}, Vector3d::Zero());
  for (int i = 0; i < 4; ++i) v.set_motor_speed(i, 400.0);
  for (int k = 0; k < 100; ++k) v.step(kStep_s);
  EXPECT_TRUE(v.state().motors[0].blocked);
  EXPECT_EQ(v.state().motors[0].speed_radps, 0.0);
  for (const int i : {1, 2, 3}) EXPECT_FALSE(v.state().motors[static_cast<std::size_t>(i)].blocked);
}

// Terminal fall of the frame alone along each of its axes: sqrt(2 m g / (rho cd A)).
TEST(Drag, TerminalSpeedIsThatOfTheAreaSeenAlongTheFall) {
  const VehicleParams params = hp_quad();
  for (int axis = 0; axis < 3; ++axis) {
    Vehicle v(params, quadratic_rotors(params.airframe), 1);
    const auto q = Eigen::Quaterniond::FromTwoVectors(Vector3d::Unit(axis), Vector3d::UnitZ());
    v.place({0, 0, -2000}, q, {0, 0, 20}, Vector3d::Zero());
    for (int k = 0; k < 15000; ++k) v.step(kStep_s);
    const VehicleState& s = v.state();
    const double area_m2 = params.airframe.drag_area_m2[axis];
    const double want = std::sqrt(2.0 * 0.9 * kGravity_mps2 / (s.air_density_kgpm3 * area_m2));
    EXPECT_TRUE(near(s.v_WB_W_mps.z(), want, stated(0.01 * want, "density grows on the way")))
        << axis;
  }
}

}  // namespace
}  // namespace whirl::plant

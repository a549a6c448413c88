// The attitude that points the rotors along a force: with a heading, and as the thesis's appendix E has it without.
#include "firmware/control/desired_attitude.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace fw {
namespace {

using whirl::near;
using whirl::stated;

constexpr float kFall_mps2 = 9.80665f;
constexpr double kDegree_rad = M_PI / 180.0;

TEST(DesiredAttitude, ItsRateIsThatOfTheAttitudeAlongTheTrajectory) {
  const auto wanted = [](double t) {
    WantedForce force;
    const double w = 2.0;
    force.f_W_mps2 = {static_cast<float>(std::cos(w * t)), static_cast<float>(std::sin(w * t)),
                      kFall_mps2};
    force.jerk_W_mps3 = {static_cast<float>(-w * std::sin(w * t)),
                         static_cast<float>(w * std::cos(w * t)), 0.0f};
    force.snap_W_mps4 = {static_cast<float>(-w * w * std::cos(w * t)),
                         static_cast<float>(-w * w * std::sin(w * t)), 0.0f};
    return resolve(force, Quaternion::Identity(), 0.3f);
  };
  const double dt = 1e-2;
  for (const double t : {0.1, 0.7, 1.9}) {
    const ThrustAndAttitude now = wanted(t);
    const Quaternion turn = wanted(t - dt / 2).q_WB.conjugate() * wanted(t + dt / 2).q_WB;
    const Vector3 rate = static_cast<float>(2.0 / dt) * turn.vec();
    // The heading is held: what turns about the body's z for that is not in the rate.
    EXPECT_TRUE(near(now.w_B_radps.x(), rate.x(), stated(0.005, "half a step's change")));
    EXPECT_TRUE(near(now.w_B_radps.y(), rate.y(), stated(0.005, "half a step's change")));
    const Vector3 change =
        (wanted(t + dt / 2).w_B_radps - wanted(t - dt / 2).w_B_radps) / static_cast<float>(dt);
    EXPECT_TRUE(near(now.w_dot_B_radps2.x(), change.x(), stated(0.03, "w x w, of 2nd order")));
    EXPECT_TRUE(near(now.w_dot_B_radps2.y(), change.y(), stated(0.03, "w x w, of 2nd order")));
  }
}

// 22 degrees are asked of it. What is left of a force that leans further points where that did, and the thrust
// is the one whose part along the vertical still carries the weight.
TEST(DesiredAttitude, AtTheLimitOfTiltItStillCarriesTheWeightAndPointsTheSameWay) {
  const ThrustAndAttitude level = resolve({{0, 0, kFall_mps2}}, Quaternion::Identity(), 0.0f);
  for (const double azimuth : {0.4, 1.9, -2.6}) {
    const Vector3 along(static_cast<float>(std::cos(azimuth)),
                        static_cast<float>(std::sin(azimuth)), 0.0f);
    for (const float sideways : {3.0f, 5.0f, 10.0f, 100.0f}) {
      const WantedForce force{.f_W_mps2 = sideways * along + kFall_mps2 * Vector3::UnitZ()};
      const Quaternion q_WB = resolve(force, Quaternion::Identity(), 0.3f).q_WB;
      const Vector3 down_W = q_WB * Vector3::UnitZ();
      const double tilt = std::acos(down_W.z()), free = std::atan2(sideways, kFall_mps2);
      EXPECT_TRUE(near(tilt, std::min(free, 22.0 * kDegree_rad),
                       stated(0.3 * kDegree_rad, "of 22 degrees")));
      EXPECT_TRUE(near(std::atan2(down_W.y(), down_W.x()), azimuth, stated(1e-3, "float")));
      const float thrust_N = resolve(force, q_WB, 0.3f).thrust_N;
      EXPECT_TRUE(near(thrust_N * down_W.z(), level.thrust_N, stated(1e-3, "float")));
    }
  }
}

// Appendix E: the third column of a rotation with q3 = 0 is (2 q0 q2, -2 q0 q1, q0^2 - q1^2 - q2^2), and q0 > 0 (E.9).
TEST(DesiredAttitude, WithoutAHeadingItIsTheOneOfAppendixE) {
  for (const float x : {-0.9f, -0.3f, 0.0f, 0.2f, 0.6f}) {
    for (const float y : {-0.4f, 0.0f, 0.1f, 0.4f}) {
      const auto q = without_heading(x, y);
      ASSERT_TRUE(q);
      EXPECT_GT(q->w(), 0.7f);
      EXPECT_EQ(q->z(), 0.0f);
      EXPECT_TRUE(near(2.0 * q->w() * q->y(), x, stated(1e-6, "float")));
      EXPECT_TRUE(near(-2.0 * q->w() * q->x(), y, stated(1e-6, "float")));
      const double down = std::sqrt(1.0 - x * x - y * y);
      const double by_q = q->w() * q->w() - q->x() * q->x() - q->y() * q->y();
      EXPECT_TRUE(near(by_q, down, stated(2e-6, "float")));
      EXPECT_TRUE(near(q->norm(), 1.0, stated(1e-6, "float")));
    }
  }
  // An axis that leans 30 degrees north is a nose up, one that leans east a roll to the left.
  const auto pitched = without_heading(0.5f, 0.0f), rolled = without_heading(0.0f, 0.5f);
  EXPECT_TRUE(near(pitched->y(), std::sin(15.0 * kDegree_rad), stated(1e-6, "float")));
  EXPECT_TRUE(near(rolled->x(), -std::sin(15.0 * kDegree_rad), stated(1e-6, "float")));
  EXPECT_TRUE(without_heading(0.6f, 0.8f - 1e-6f));
  EXPECT_FALSE(without_heading(0.8f, 0.61f));
  EXPECT_FALSE(without_heading(-1.01f, 0.0f));
  EXPECT_FALSE(without_heading(std::nanf(""), 0.0f));
}

TEST(DesiredAttitude, WithoutAHeadingForceAndThrustAreTheSame) {
  for (const Vector3& f_W :
       {Vector3(2.0f, -1.0f, kFall_mps2), Vector3(0, 0, kFall_mps2), Vector3(-9, 9, kFall_mps2)}) {
    const WantedForce wanted{.f_W_mps2 = f_W};
    const ThrustAndAttitude with = resolve(wanted, Quaternion::Identity(), 1.2f);
    const ThrustAndAttitude without = resolve(wanted, Quaternion::Identity(), std::nullopt);
    EXPECT_EQ(with.thrust_N, without.thrust_N);
    const Vector3 apart = with.q_WB * Vector3::UnitZ() - without.q_WB * Vector3::UnitZ();
    EXPECT_TRUE(near(apart.norm(), 0.0, stated(1e-6, "float")));
    EXPECT_TRUE(near(without.q_WB.z(), 0.0, stated(1e-6, "float")));
  }
  const Quaternion held(0.8f, 0.0f, 0.0f, 0.6f);  // what is no number is no attitude
  const WantedForce nonsense{.f_W_mps2 = {std::nanf(""), 0, kFall_mps2}};
  EXPECT_TRUE(near(resolve(nonsense, held, std::nullopt).q_WB.angularDistance(held), 0.0,
                   stated(1e-3, "float")));
}

}  // namespace
}  // namespace fw

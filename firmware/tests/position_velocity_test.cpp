// The controllers of place and velocity in closed form: what a trajectory takes, with nothing to correct, and what
// velocity learns of a push that stays.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "firmware/config/vehicle.hpp"
#include "firmware/control/position_controller.hpp"
#include "firmware/control/velocity_controller.hpp"

namespace fw {
namespace {

using whirl::near, whirl::stated;

constexpr float kOneG_mps2 = config::kGravity_mps2, kControl_s = 0.025f;
constexpr double kRadius_m = 0.5, kTurn_radps = 2.0;

// At `t` of a level circle: 1 m/s, 2 m/s^2.
Reference on_circle(double t) {
  const auto derivative = [&](int order) {
    const double size = kRadius_m * std::pow(kTurn_radps, order);
    const double angle = kTurn_radps * t + order * M_PI / 2.0;
    return Vector3(static_cast<float>(size * std::cos(angle)),
                   static_cast<float>(size * std::sin(angle)), 0.0f);
  };
  Reference reference;
  reference.follow({.p_W_m = derivative(0), .v_W_mps = derivative(1), .a_W_mps2 = derivative(2)},
                   derivative(3), 0.0f, kControl_s);
  return reference;
}

ThrustAndAttitude wanted_on_circle(double t, float drag_spm) {
  const Reference r = on_circle(t);
  PositionController controller;
  controller.set_drag(drag_spm);
  const Quaternion q_WB =
      controller.step(r.p_W_m(), r.v_W_mps(), Quaternion::Identity(), r, 1.0f, kControl_s, false)
          .q_WB;
  return controller.step(r.p_W_m(), r.v_W_mps(), q_WB, r, 1.0f, kControl_s, false);
}

// m dv/dt = m g e3 - T R e3 - c T v, with the thrust that carries the weight in the drag's term.
TEST(PositionController, OnATrajectoryThrustGravityAndDragMakeItsAcceleration) {
  for (const float drag_spm : {0.0f, 0.033f, 0.05f}) {
    for (const double t : {0.0, 0.4, 1.7}) {
      const ThrustAndAttitude out = wanted_on_circle(t, drag_spm);
      const Reference r = on_circle(t);
      const Vector3 a_W = kOneG_mps2 * Vector3::UnitZ() -
                          out.thrust_N / config::kMass_kg * (out.q_WB * Vector3::UnitZ()) -
                          drag_spm * kOneG_mps2 * r.v_W_mps();
      EXPECT_TRUE(near((a_W - r.a_W_mps2()).norm(), 0.0, stated(1e-4, "float, of 2 m/s2 and 1 g")));
    }
  }
}

TEST(PositionController, OnATrajectoryItsRateIsTheOneAtWhichTheWantedAttitudeTurns) {
  constexpr double dt = 1e-2;
  for (const float drag_spm : {0.0f, 0.05f}) {
    for (const double t : {0.1, 0.7, 1.9}) {
      const ThrustAndAttitude now = wanted_on_circle(t, drag_spm);
      const Quaternion turn = wanted_on_circle(t - dt / 2, drag_spm).q_WB.conjugate() *
                              wanted_on_circle(t + dt / 2, drag_spm).q_WB;
      const Vector3 rate = static_cast<float>(2.0 / dt) * turn.vec();
      EXPECT_GT(rate.head<2>().norm(), 0.3f);  // 2 rad/s of 2 m/s^2 of 1 g
      EXPECT_TRUE(near(now.w_B_radps.x(), rate.x(), stated(0.005, "half a step's change")));
      EXPECT_TRUE(near(now.w_B_radps.y(), rate.y(), stated(0.005, "half a step's change")));
    }
  }
}

// A point mass that leans at once.
struct PushedMass {
  VelocityController controller;
  Vector3 v_W_mps = Vector3::Zero();
  Reference stands;

  void step(float push_north_mps2) {
    const Quaternion q_WB =
        controller.step(v_W_mps, Quaternion::Identity(), stands, kOneG_mps2, kControl_s).q_WB;
    const Vector3 axis = q_WB * Vector3::UnitZ();
    v_W_mps.x() += kControl_s * (push_north_mps2 - kOneG_mps2 * axis.x() / axis.z());
  }
  void step_for(float time_s, float push_north_mps2) {
    for (float t = 0.0f; t < time_s; t += kControl_s) step(push_north_mps2);
  }
};

TEST(VelocityController, LearnsAPushThatStays) {
  PushedMass mass;
  mass.step_for(1.0f, 1.0f);
  EXPECT_GT(mass.v_W_mps.x(), 0.1f);  // by its gain alone it would stay 0.36 m/s off
  mass.step_for(15.0f, 1.0f);
  EXPECT_TRUE(near(mass.v_W_mps.x(), 0.0, stated(0.01, "six of its slowest time constants")));
}

// Held for a second at 5 m/s beside what it was asked for, it learns no more than 0.6 m/s are worth.
TEST(VelocityController, LearnsLittleFromAnErrorThatIsNone) {
  VelocityController controller;
  const Reference stands;
  for (int i = 0; i < 40; ++i) {
    controller.step({5.0f, 0.0f, 0.0f}, Quaternion::Identity(), stands, kOneG_mps2, kControl_s);
  }
  const Vector3 axis =
      controller.step(Vector3::Zero(), Quaternion::Identity(), stands, kOneG_mps2, kControl_s)
          .q_WB *
      Vector3::UnitZ();
  EXPECT_LT(kOneG_mps2 * axis.x() / axis.z(), 1.2f * 0.6f * 1.0f + 0.01f);
}

}  // namespace
}  // namespace fw

#include <gtest/gtest.h>

#include "base/near.hpp"
#include "firmware/control/attitude_controller.hpp"
#include "firmware/estimation/attitude_filter.hpp"
#include "firmware/estimation/ground_calibration.hpp"

namespace fw {
namespace {

using whirl::near, whirl::stated;

constexpr float kG = 9.80665f;

float angle_between(const Quaternion& a, const Quaternion& b) {
  return 2.0f * std::acos(std::min(1.0f, std::abs(a.dot(b))));
}

TEST(AttitudeFilter, StartsFromTheDirectionOfGravity) {
  // Rolled right by 0.3, pitched up by -0.2: specific force is -g turned into B.
  const Quaternion truth = from_euler(0.3f, -0.2f, 1.0f);
  AttitudeFilter filter;
  filter.start(truth.conjugate() * Vector3(0, 0, -kG), 1.0f);
  EXPECT_LT(angle_between(filter.q_WB(), truth), 1e-3f);
}

TEST(AttitudeFilter, IntegratesARateExactly) {
  AttitudeFilter filter;  // half a turn about z in a second, no gravity to listen to
  for (int i = 0; i < 200; ++i) filter.update({0, 0, 3.14159265f}, Vector3::Zero(), 0.005f, 1.0f);
  EXPECT_LT(angle_between(filter.q_WB(), Quaternion(0, 0, 0, 1)), 1e-3f);
}

TEST(AttitudeFilter, GravityPullsAWrongTiltBackWithItsTimeConstant) {
  AttitudeFilter filter;
  filter.start(from_euler(0.2f, 0, 0).conjugate() * Vector3(0, 0, -kG), 0.0f);
  for (int i = 0; i < 200; ++i) filter.update(Vector3::Zero(), {0, 0, -kG}, 0.005f, 1.0f);
  // Closed form of x' = -x with a slow bias that takes up 5 % of it: 0.2 / e, within 10 %.
  const float left = std::asin(2.0f * filter.q_WB().x());
  EXPECT_TRUE(near(left, 0.2 * std::exp(-1.0), stated(0.0075, "the bias's share")));
}

TEST(AttitudeFilter, LearnsAGyroBiasFromGravity) {
  AttitudeFilter filter;
  const Vector3 bias(0.02f, -0.03f, 0.0f);
  for (int i = 0; i < 200 * 120; ++i) filter.update(bias, {0, 0, -kG}, 0.005f, 1.0f);
  EXPECT_TRUE(
      near((filter.gyro_bias_B_radps() - bias).norm(), 0.0, stated(0.003, "6 time constants")));
}

TEST(AttitudeFilter, DoesNotBelieveGravityOutsideOneG) {
  AttitudeFilter filter;
  for (int i = 0; i < 200; ++i) filter.update(Vector3::Zero(), {0, 15.0f, 0}, 0.005f, 1.0f);
  EXPECT_LT(angle_between(filter.q_WB(), Quaternion::Identity()), 1e-6f);
}

TEST(AttitudeFilter, HeadingFixTurnsTheShortWayRound) {
  AttitudeFilter filter;
  filter.start({0, 0, -kG}, 3.0f);
  filter.correct_heading(-3.0f, 0.5f);  // 0.283 rad further, not 6 rad back
  EXPECT_TRUE(near(std::abs(yaw_of(filter.q_WB())), M_PI, stated(1e-3, "float trigonometry")));
}

TEST(GroundCalibration, FindsBothBiasesOnASlope) {
  const Quaternion slope = from_euler(0.05f, -0.04f, 2.0f);
  const Vector3 w_bias(0.1f, -0.2f, 0.05f), a_bias(0.3f, -0.2f, 0.5f);
  const Vector3 a = slope.conjugate() * Vector3(0, 0, -kG) + a_bias;
  GroundCalibration calibration;
  bool done = false;
  for (int i = 0; i < 200; ++i) done = calibration.add(w_bias, a, slope);
  ASSERT_TRUE(done);
  EXPECT_LT((calibration.gyro_bias_B_radps() - w_bias).norm(), 1e-4f);
  EXPECT_LT((calibration.accel_bias_B_mps2() - a_bias).norm(), 1e-3f);
}

TEST(GroundCalibration, StartsOverWhenTouched) {
  GroundCalibration calibration;
  bool done = false;
  for (int i = 0; i < 399; ++i) {
    const Vector3 w(i == 199 ? 0.2f : 0.0f, 0, 0);
    done = done || calibration.add(w, {0, 0, -kG}, Quaternion::Identity());
  }
  EXPECT_FALSE(done);
}

TEST(AttitudeController, TurnsBackTheShortWay) {
  AttitudeController controller;
  const Quaternion rolled = from_euler(0.2f, 0, 0);
  Quaternion same = rolled;
  same.coeffs() = -same.coeffs();  // the same attitude by the other quaternion
  const Vector3 tau = controller.torque(rolled, Vector3::Zero(), ThrustAndAttitude{}, 0, false);
  EXPECT_LT(tau.x(), 0.0f);
  EXPECT_LT((controller.torque(same, Vector3::Zero(), ThrustAndAttitude{}, 0, false) - tau).norm(),
            1e-6f);
}

TEST(AttitudeController, DampsAndBalancesTheGyroscopicTorque) {
  AttitudeController controller;
  const Vector3 w(1.0f, 2.0f, 3.0f);
  const Vector3 with = controller.torque(Quaternion::Identity(), w, ThrustAndAttitude{}, 0, false);
  const Vector3 against =
      controller.torque(Quaternion::Identity(), -w, ThrustAndAttitude{}, 0, false);
  // Damping is odd in the rate, w x I w is even: half the sum is (Izz - Iyy) wy wz and so on.
  const Vector3 even = 0.5f * (with + against);
  EXPECT_TRUE(near(even.x(), (0.0235 - 0.0125) * 2 * 3, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(even.y(), (0.0125 - 0.0235) * 3 * 1, stated(1e-5, "float round-off")));
  EXPECT_LT((with - even).dot(w), 0.0f);
}

// A rigid body of Euler's, with the vehicle's inertia (its parts list), that feels what the controller asks for.
struct RigidBody {
  Eigen::Vector3d inertia{0.0125, 0.0125, 0.0235}, w_B{0, 0, 0};
  Eigen::Quaterniond q_WB{1, 0, 0, 0};
  Eigen::Vector3d alpha_B(const Vector3& tau_Nm) const {
    const Eigen::Vector3d momentum = inertia.cwiseProduct(w_B);
    return (tau_Nm.cast<double>() - w_B.cross(momentum)).cwiseQuotient(inertia);
  }
  void step(const Vector3& tau_Nm, double dt_s) {
    w_B += dt_s * alpha_B(tau_Nm);
    const Eigen::Vector3d half = 0.5 * dt_s * w_B;
    q_WB = (q_WB * Eigen::Quaterniond(1.0, half.x(), half.y(), half.z())).normalized();
  }
};

// What turns as it is asked to, about a skew axis, goes on turning so: no torque of its own making is felt.
TEST(AttitudeController, WhatTurnsAsWantedAboutASkewAxisIsNotDisturbed) {
  RigidBody body;
  body.w_B = {2.0, -1.5, 3.0};
  ThrustAndAttitude wanted;
  wanted.w_B_radps = body.w_B.cast<float>();
  AttitudeController controller;
  const Vector3 tau = controller.torque(wanted.q_WB, wanted.w_B_radps, wanted, 0.005f, false);
  // Uncompensated 5.3 rad/s2; the wrong way twice that.
  EXPECT_LT(body.alpha_B(tau).norm(), 1e-4);
}

// An oscillation of 20 degrees at 1 Hz about each axis. Known in advance it is followed but for the round-off of
// rectangles of a millisecond (half of one at 2.2 rad/s); who waits for the error to grow is 4 to 15 degrees off.
TEST(AttitudeController, FollowsAnAccelerationThatIsKnownInAdvanceWithoutAnError) {
  for (int axis = 0; axis < 3; ++axis) {
    const double f = 2.0 * M_PI, size = 20.0 * M_PI / 180.0, dt = 1e-3;
    const Eigen::Vector3d about = Eigen::Vector3d::Unit(axis);
    RigidBody body;
    body.w_B = size * f * about;  // at the swing's middle
    AttitudeController controller;
    double worst_rad = 0.0;
    for (double t = 0.0; t < 3.0; t += dt) {
      const Eigen::Quaterniond q(Eigen::AngleAxisd(size * std::sin(f * t), about));
      worst_rad = std::max(worst_rad, q.angularDistance(body.q_WB));
      ThrustAndAttitude wanted{.q_WB = q.cast<float>()};
      wanted.w_B_radps = (size * f * std::cos(f * t) * about).cast<float>();
      wanted.w_dot_B_radps2 = (-size * f * f * std::sin(f * t) * about).cast<float>();
      body.step(controller.torque(body.q_WB.cast<float>(), body.w_B.cast<float>(), wanted,
                                  static_cast<float>(dt), false),
                dt);
    }
    EXPECT_LT(worst_rad, 0.2 * M_PI / 180.0) << axis;
  }
}

}  // namespace
}  // namespace fw

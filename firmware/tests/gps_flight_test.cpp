// Flight without motion capture around a rigid body of other hands.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "firmware/tests/outdoors.hpp"

namespace fw::test {
namespace {

using whirl::near;
using whirl::stated;

TEST(GpsFrame, MetresAreTheEllipsoids) {
  GpsFrame frame;
  for (int i = 0; i < GpsFrame::kOriginFixes; ++i) {
    EXPECT_FALSE(frame.known());
    frame.learn(solution_at({i % 2 ? 3.0 : -3.0, 0, 0}, {0, 0, 0}));
  }
  ASSERT_TRUE(frame.known());
  const Vector3 p = frame.local(solution_at({800.0, -500.0, -20.0}, {0, 0, 0}));
  // An odd number of solutions: the mean is 3 m / 25 off; and 4 mm per 800 m of the float.
  EXPECT_TRUE(near(p.x(), 800.12, stated(0.02, "1 cm of latitude, and floats")));
  EXPECT_TRUE(near(p.y(), -500.0, stated(0.06, "parallels shrink by 0.01 % in 800 m")));
  EXPECT_TRUE(near(p.z(), -20.0, stated(0.002, "1 mm")));
}

TEST(GpsFrame, GoesOnBeyondTheDateLine) {
  GpsFrame frame;
  GpsSolution s = solution_at({0, 0, 0}, {0, 0, 0});
  s.longitude_e7_deg = 1'799'999'000;
  for (int i = 0; i < GpsFrame::kOriginFixes; ++i) frame.learn(s);
  s.longitude_e7_deg = -1'799'999'000;
  EXPECT_TRUE(
      near(frame.local(s).y(), 2000e-7 * degree_east_m(kLatitude_deg), stated(0.01, "1 cm")));
}

TEST(GpsFlight, HoversWhereItsReceiverSeesIt) {
  Outdoors out;
  out.p_error_m = {4.0, -7.0, 10.0};  // in the origin, too
  out.hover();
  EXPECT_TRUE(near(out.vehicle.p_W_.x(), 0.0, stated(0.2, "accelerometer's zero points")));
  EXPECT_TRUE(near(out.vehicle.p_W_.y(), 0.0, stated(0.2, "accelerometer's zero points")));
  EXPECT_TRUE(near(out.vehicle.p_W_.z(), -6.1, stated(0.2, "the origin is 10 cm up")));
  out.p_error_m.x() += 2.0;  // it has wandered: within the gate
  out.run(8.0);
  EXPECT_TRUE(near(out.vehicle.p_W_.x(), -2.0, stated(0.2, "the same")));
  EXPECT_TRUE(out.flight.estimator().position_known());
}

// A receiver of data-sheet accuracy (CEP 2.5 m) whose error wanders with 60 s: it changes by 17 cm along each axis
// from one solution to the next, so that staying with it is a matter of following fast enough.
TEST(GpsFlight, StaysWithinHalfAMetreOfAReceiverThatWanders) {
  double mean_m = 0.0;
  for (unsigned seed = 2; seed <= 11; ++seed) {
    Outdoors out;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto wander = [&] {
      const double fade = std::exp(-0.2 / 60.0), kick = 2.12 * std::sqrt(1.0 - fade * fade);
      for (int i = 0; i < 2; ++i) {
        out.p_error_m[i] = fade * out.p_error_m[i] + kick * normal(random);
        out.v_error_mps[i] = 0.085 * normal(random);
      }
    };
    out.p_error_m = {2.12 * normal(random), 2.12 * normal(random), 0.0};
    const Eigen::Vector3d first_m = out.p_error_m;  // in the origin: it stands still until take-off
    out.hover();
    out.vehicle.wind_W_ = {0, 3, 0};
    double sum = 0.0;
    constexpr int kSettling = 50, kSteps = 350;
    for (int step = 0; step < kSteps; ++step) {
      wander();
      for (int ms = 0; ms < 200; ms += 20) {
        out.run(0.02);
        const Eigen::Vector3d seen_m = out.vehicle.p_W_ + out.p_error_m - first_m;
        if (step >= kSettling) sum += seen_m.head<2>().squaredNorm() / 10 / (kSteps - kSettling);
      }
    }
    EXPECT_LT(std::sqrt(sum), 0.6) << seed;
    mean_m += 0.1 * std::sqrt(sum);
  }
  EXPECT_LT(mean_m, 0.5);
}

TEST(GpsFlight, TakesItsHeadingFromTheField) {
  Outdoors out(2.0);
  out.run(12.0);
  // The zero points tilt it by 2.3 degrees, which the dip of 66 degrees makes 5 of heading.
  EXPECT_TRUE(near(wrap_pi(yaw_of(out.flight.estimator().q_WB()) - 2.0f), 0.0,
                   stated(0.12, "zero points of the accelerometer, and 2 degrees to converge")));
}

TEST(GpsFlight, IsNotArmedBeforeTheReceiverHasSettled) {
  Outdoors out;
  out.accuracy_m = 15.0f;
  out.run(12.0);
  EXPECT_EQ(out.flight.arm(), Reason::no_position);
  out.accuracy_m = 3.0f;
  out.run(4.0);
  EXPECT_EQ(out.flight.arm(), Reason::no_position);  // no origin yet
  out.run(4.0);
  EXPECT_EQ(out.flight.arm(), Reason::none) << text_of(out.flight.ready_to_arm());
}

TEST(GpsFlight, ASilentOrJammedReceiverIsNoPositionAfterASecond) {
  for (const bool jammed : {false, true}) {
    Outdoors out;
    out.hover();
    jammed ? void(out.fix_type = 0) : void(out.gps_on = false);
    out.run(0.9);
    EXPECT_TRUE(out.flight.estimator().position_known());
    out.run(0.6);
    EXPECT_FALSE(out.flight.estimator().position_known());
    EXPECT_EQ(out.flight.last_reason(), Reason::no_position);
    EXPECT_EQ(out.flight.state(), FlightState::failsafe);
  }
}

// What it told last was a metre a second: half a second of that, and a second until it counts as lost.
TEST(GpsFlight, AReceiverThatTellsTheSameForEverIsNoPositionAfterTwoSeconds) {
  Outdoors out;
  out.hover();
  out.v_error_mps.x() = 1.0;
  out.run(0.2);
  const Eigen::Vector3d before_m = out.vehicle.p_W_;
  out.stuck = true;
  out.run(2.0);
  EXPECT_FALSE(out.flight.estimator().position_known());
  EXPECT_EQ(out.flight.last_reason(), Reason::no_position);
  EXPECT_LT((out.vehicle.p_W_ - before_m).head<2>().norm(), 3.0);
  out.stuck = false;
  out.v_error_mps.setZero();
  out.run(3.0);
  EXPECT_TRUE(out.flight.estimator().position_known());
}

TEST(GpsFlight, AJumpOrAFalseVelocityIsNotFollowed) {
  for (const bool jump : {false, true}) {
    Outdoors out;
    out.hover();
    const Eigen::Vector3d before_m = out.vehicle.p_W_;
    (jump ? out.p_error_m.x() : out.v_error_mps.x()) += 15.0;
    out.run(1.6);
    EXPECT_FALSE(out.flight.estimator().position_known());
    EXPECT_LT((out.vehicle.p_W_ - before_m).head<2>().norm(), 0.5);
  }
}

// From 6 m it takes 17 s: the rotors turn until it is down.
TEST(GpsFlight, WithoutAPositionItSinksToTheGround) {
  Outdoors out;
  out.hover();
  out.gps_on = false;
  double fastest_mps = 0.0;
  for (int i = 0; i < 300 && out.flight.state() != FlightState::disarmed; ++i) {
    out.run(0.1);
    fastest_mps = std::max(fastest_mps, out.vehicle.v_W_.z());
  }
  EXPECT_EQ(out.flight.state(), FlightState::disarmed);
  EXPECT_LT(-out.vehicle.p_W_.z(), 0.3);
  EXPECT_LT(fastest_mps, 1.0);
}

// It comes back elsewhere, and twice as wrong: no speed is made of that.
TEST(GpsFlight, AReceiverThatComesBackAfterAGapIsTakenWhereItIs) {
  Outdoors out;
  out.hover();
  out.gps_on = false;
  out.run(3.0);
  EXPECT_FALSE(out.flight.estimator().position_known());
  out.gps_on = true;
  out.p_error_m = {2.5, -2.5, 0};
  double fastest_mps = 0.0;
  for (int i = 0; i < 40; ++i) {
    out.run(0.1);
    fastest_mps = std::max(fastest_mps, out.vehicle.v_W_.head<2>().norm());
  }
  EXPECT_TRUE(out.flight.estimator().position_known());
  EXPECT_LT(fastest_mps, 0.8);
  const Vector3 v_error = out.flight.estimator().v_WB_W_mps() - out.vehicle.v_W_.cast<float>();
  EXPECT_LT(v_error.head<2>().norm(), 0.3f);
}

TEST(GpsFlight, AStepWithinTheGateIsWalkedNotJumped) {
  Outdoors out;
  out.hover();
  out.p_error_m = {2.8, 0, 0};
  double fastest_mps = 0.0;
  for (int i = 0; i < 60; ++i) {
    out.run(0.1);
    fastest_mps = std::max(fastest_mps, out.vehicle.v_W_.head<2>().norm());
  }
  EXPECT_TRUE(out.flight.estimator().position_known());
  EXPECT_LT(fastest_mps, 3.0);
  EXPECT_TRUE(near(out.vehicle.p_W_.x(), -2.8, stated(0.3, "accelerometer's zero points")));
}

// What no sensor on board can tell from wind: it is carried along, at that speed and no faster.
TEST(GpsFlight, AConsistentSlowDriftIsFollowed) {
  Outdoors out;
  out.hover();
  out.v_error_mps = out.drift_mps = {0.3, 0, 0};
  const double before_m = out.vehicle.p_W_.x();
  out.run(10.0);
  EXPECT_TRUE(out.flight.estimator().position_known());
  EXPECT_TRUE(near(out.vehicle.p_W_.x() - before_m, -3.0, stated(0.6, "two seconds of the drift")));
}

TEST(GpsFlight, WithCaptureItCountsNothing) {
  Outdoors out;
  out.vehicle.capture_on_ = true;
  out.run(12.0);
  ASSERT_EQ(out.flight.arm(), Reason::none) << text_of(out.flight.ready_to_arm());
  out.run(1.0);
  ASSERT_EQ(out.flight.take_off(1.1f), Reason::none);
  out.p_error_m = {2.0, 0, 0};
  out.run(8.0);
  EXPECT_TRUE(near(out.vehicle.p_W_.x(), 0.0, stated(0.05, "5 cm: the sensors' noise and bias")));
  out.vehicle.capture_on_ = false;  // nor after it: its frame is another one
  out.run(0.6);
  EXPECT_FALSE(out.flight.estimator().position_known());
}

TEST(GpsFlight, AReceiverThatJumpsAtRestIsBelievedAgain) {
  Outdoors out;
  out.run(12.0);
  out.p_error_m.x() = 30.0;
  out.run(8.0);
  EXPECT_TRUE(out.flight.estimator().position_known());
  EXPECT_TRUE(near(out.flight.estimator().p_WB_W_m().x(), 30.0, stated(0.3, "noise")));
}

}  // namespace
}  // namespace fw::test

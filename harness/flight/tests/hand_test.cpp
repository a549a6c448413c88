// The vehicle in a hand: how it is moved, what its sensors must feel there, and what is refused.
#include "harness/flight/hand.hpp"

#include "base/near.hpp"
#include "harness/flight/tests/piloted_flight.hpp"

namespace whirl::flight {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const Grip kStart{{0.0, 0.0, -1.0}, Quaterniond::Identity()};

Grip rolled(double angle_rad) {
  return {kStart.p_WB_W_m, Quaterniond(Eigen::AngleAxisd(angle_rad, Vector3d::UnitX()))};
}

// A minimum-jerk course is half way after half of its time, at 15/8 of its mean speed [Flash 1985].
TEST(Hand, TurnsByAMinimumJerkCourse) {
  Hand hand(kStart, 10.0, 1);
  hand.move(rolled(2.0), 11.0, 4.0);
  const auto angle_rad = [&](double t_s) {
    return hand.course(t_s).q_WB.angularDistance(Quaterniond::Identity());
  };
  EXPECT_EQ(angle_rad(11.0), 0.0);
  EXPECT_TRUE(near(angle_rad(13.0), 1.0, round_off(100, 1.0)));
  EXPECT_TRUE(near(angle_rad(15.0), 2.0, round_off(100, 2.0)));
  EXPECT_TRUE(near(angle_rad(20.0), 2.0, round_off(100, 2.0)));
  const double rate_radps = (angle_rad(13.001) - angle_rad(12.999)) / 0.002;
  EXPECT_TRUE(near(rate_radps, 15.0 / 8.0 * 2.0 / 4.0, stated(1e-6, "a difference")));
}

TEST(Hand, ANewCourseWhileItMovesChangesNoSpeedAtOnceAndEndsAtItsGoal) {
  Hand once(kStart, 0.0, 1);
  once.move(rolled(1.5), 1.0, 2.0);
  Hand twice = once;
  const Grip goal{{0.5, 0.0, -1.5}, Quaterniond(Eigen::AngleAxisd(-1.0, Vector3d::UnitY()))};
  twice.move(goal, 2.0, 2.0);
  const auto before = once.body(2.001), after = twice.body(2.001);
  EXPECT_TRUE(
      near((before.w_WB_B_radps - after.w_WB_B_radps).norm(), 0.0, stated(1e-4, "2 ms in")));
  EXPECT_TRUE(near((before.v_WB_W_mps - after.v_WB_W_mps).norm(), 0.0, stated(1e-4, "2 ms in")));
  const Grip end = twice.course(5.0);
  EXPECT_TRUE(near(end.q_WB.angularDistance(goal.q_WB), 0.0, stated(1e-7, "acos near 1")));
  EXPECT_TRUE(near((end.p_WB_W_m - goal.p_WB_W_m).norm(), 0.0, round_off(100, 1.0)));
}

// Still is not mathematically still: RMS of the sway over 60 s as the header states it, no drift.
TEST(Hand, TremblesByTheSeed) {
  Hand hand(kStart, 0.0, 1), other(kStart, 0.0, 2);
  Vector3d sum = Vector3d::Zero(), squares = Vector3d::Zero();
  constexpr int kLooks = 60'000;
  for (int i = 0; i < kLooks; ++i) {
    const Vector3d off_m = hand.body(1.0 + 1e-3 * i).p_WB_W_m - kStart.p_WB_W_m;
    sum += off_m;
    squares += off_m.cwiseAbs2();
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(near(std::sqrt(squares[axis] / kLooks), 1.5e-3, stated(0.5e-3, "60 s of it")));
    EXPECT_TRUE(near(sum[axis] / kLooks, 0.0, stated(1e-4, "periods that were cut")));
  }
  EXPECT_NE(hand.body(5.0).p_WB_W_m, other.body(5.0).p_WB_W_m);
  EXPECT_EQ(hand.body(0.0).p_WB_W_m, kStart.p_WB_W_m);  // it takes hold without a jerk
}

// What a hand's rate says adds up to where it has turned the body.
TEST(Hand, TheRateItTellsIsThatOfItsTurn) {
  Hand hand(kStart, 0.0, 3);
  hand.move({kStart.p_WB_W_m, Quaterniond(0.3, -0.5, 0.7, 0.2).normalized()}, 0.0, 2.0);
  Quaterniond added = kStart.q_WB;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d step_rad = 1e-3 * hand.body(1e-3 * (i + 0.5)).w_WB_B_radps;
    if (step_rad.norm() > 0.0) {
      added = added * Quaterniond(Eigen::AngleAxisd(step_rad.norm(), step_rad.normalized()));
    }
  }
  EXPECT_TRUE(near(added.angularDistance(hand.body(3.0).q_WB), 0.0, stated(1e-5, "steps of 1 ms")));
}

std::string refusal(Flight& flight, const std::string& words) {
  const auto done = plan::hold(flight.world, table(words), flight.t_ns);
  return done.ok() ? "" : done.error().message();
}

io::BodyMotion motion_of(const io::Batch& sensed) {
  for (io::Reader r(sensed.bytes()); r.next();) {
    if (r.header().kind == io::Kind::body_motion) return r.as<io::BodyMotion>();
  }
  ADD_FAILURE() << "no body_motion";
  return {};
}

// Upside down the specific force is gravity the other way; on the right side gravity pulls along +y, so
// that the accelerometer reads -y. Nobody feels the way there afterwards.
TEST(InHand, TheAccelerometerFeelsGravityFromEachSide) {
  const struct {
    const char* words;
    Vector3d felt_mps2;
  } kSides[] = {{"{ over = '1 s' }", {0, 0, -9.80665}},
                {"{ roll = '180 deg', over = '1 s' }", {0, 0, 9.80665}},
                {"{ roll = '90 deg', over = '1 s' }", {0, -9.80665, 0}},
                {"{ pitch = '90 deg', over = '1 s' }", {9.80665, 0, 0}}};
  Flight flight;
  flight.run(0.5);
  for (const auto& side : kSides) {
    ASSERT_EQ(refusal(flight, side.words), "");
    flight.run(1.0);
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < 2000; ++i) {
      flight.step();
      sum += Eigen::Map<const Vector3d>(motion_of(flight.sensed).specific_force_B_mps2);
    }
    EXPECT_TRUE(near((sum / 2000.0 - side.felt_mps2).norm(), 0.0, stated(0.1, "sway of 0.2 deg")))
        << side.words;
    EXPECT_TRUE(near(flight.value("height"), 1.0, stated(0.01, "sway")));
    EXPECT_EQ(flight.value("on_ground"), 0.0);
  }
}

TEST(InHand, ReleasedItFallsAndPutDownItStands) {
  Flight flight;
  flight.run(0.5);
  ASSERT_EQ(refusal(flight, "{ height = '2 m', over = '1 s' }"), "");
  flight.run(2.0);
  ASSERT_TRUE(plan::release(flight.world, table("{}"), flight.t_ns).ok());
  flight.run(0.3);
  EXPECT_TRUE(near(flight.value("climb"), -0.3 * 9.80665, stated(0.1, "sway, drag")));

  Flight other;
  other.run(0.5);
  ASSERT_EQ(refusal(other, "{ roll = '90 deg', yaw = '30 deg', over = '1 s' }"), "");
  other.run(2.0);
  ASSERT_TRUE(plan::release(other.world, table("{ over = '2 s' }"), other.t_ns).ok());
  EXPECT_EQ(refusal(other, "{}"), "plan.lua: hold: it is being put down (wait until it stands)");
  other.run(3.0);
  EXPECT_EQ(other.value("on_ground"), 1.0);
  EXPECT_TRUE(near(other.value("tilt"), 0.0, stated(1e-3, "on its gear")));
  EXPECT_TRUE(near(other.value("speed_1"), 0.0, stated(1e-9, "no propeller struck")));
}

TEST(InHand, RefusesWhatNoHandCanDo) {
  Flight flight;
  flight.run(0.5);
  EXPECT_EQ(
      refusal(flight, "{ height = '30 cm', roll = '90 deg' }"),
      "plan.lua:1: height: its lowest point would be within 5 cm of the floor (hold it higher)");
  EXPECT_EQ(
      refusal(flight, "{ height = '45 cm', roll = '180 deg' }"),
      "plan.lua: hold: on its way there it would touch the floor (lift it level first: t:hold { "
      "height = \"1 m\" })");
  EXPECT_NE(refusal(flight, "{ over = '1 ms' }"), "");
  EXPECT_NE(refusal(flight, "{ tilt = '10 deg' }"), "");
  const auto nobody = plan::release(flight.world, table("{}"), flight.t_ns);
  ASSERT_FALSE(nobody.ok());
  EXPECT_EQ(nobody.error().message(), "plan.lua: release: nobody holds it (t:hold comes first)");
  ASSERT_EQ(refusal(flight, "{ height = '2.5 m' }"), "");
  flight.run(2.5);
  ASSERT_TRUE(plan::release(flight.world, table("{}"), flight.t_ns).ok());
  flight.run(0.2);
  EXPECT_EQ(refusal(flight, "{}"),
            "plan.lua: hold: it moves too fast to be caught (below 0.5 m/s and 1 rad/s)");
}

}  // namespace
}  // namespace whirl::flight

// A magnetometer, a barometer and a capture system that tell nonsense in flight, around a rigid body of other hands: what
// is not believed moves nobody, and who can go by nothing comes down.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "firmware/tests/outdoors.hpp"

namespace fw::test {
namespace {

using Eigen::Vector3d;
using whirl::near;
using whirl::stated;

struct Course {
  double farthest_m = 0.0, steepest_rad = 0.0, heading_rad = 0.0, lowest_m = 1e9, highest_m = -1e9;
};

// What became of it in so many seconds, from where it was.
template <typename Flying>
Course course(Flying& flying, double seconds) {
  Course seen;
  const Vector3d from = flying.vehicle.p_W_;
  for (long i = std::lround(100 * seconds); i > 0; --i) {
    flying.run(0.01);
    const VehicleModel& v = flying.vehicle;
    const Eigen::Vector3d nose = v.q_WB_ * Vector3d::UnitX();
    const auto true_yaw = static_cast<float>(std::atan2(nose.y(), nose.x()));
    const float off = wrap_pi(yaw_of(flying.flight.estimator().q_WB()) - true_yaw);
    seen.farthest_m = std::max(seen.farthest_m, (v.p_W_ - from).head<2>().norm());
    seen.steepest_rad = std::max(seen.steepest_rad, v.tilt_rad());
    seen.heading_rad = std::max(seen.heading_rad, std::abs(double(off)));
    seen.lowest_m = std::min(seen.lowest_m, -v.p_W_.z());
    seen.highest_m = std::max(seen.highest_m, -v.p_W_.z());
  }
  return seen;
}

// From 1.1 m up in the capture system's room.
struct Indoors {
  Indoors() : vehicle({}) {
    run(8.0);
    EXPECT_EQ(flight.arm(), Reason::none) << text_of(flight.ready_to_arm());
    run(1.0);
    EXPECT_EQ(flight.take_off(1.1f), Reason::none);
    run(8.0);
  }
  void run(double seconds) { vehicle.run(flight, seconds); }
  Flight flight;
  VehicleModel vehicle;
};

TEST(FieldGuard, AMagnetThatComesInFlightTurnsNoHeadingAndItLandsByTheGyrosAlone) {
  for (const Vector3d& magnet_uT :
       {Vector3d(30, 0, 0), Vector3d(-60, 0, 0), Vector3d(0, 40, 0), Vector3d(0, 0, 25)}) {
    Outdoors out(0.7);
    out.hover();
    out.vehicle.wind_W_ = {0, 3, 0};
    const Course before = course(out, 10.0);
    out.vehicle.field_error_B_uT_ = magnet_uT;
    const Course seen = course(out, 19.0);
    EXPECT_LT(seen.heading_rad, before.heading_rad + 0.03) << magnet_uT;
    EXPECT_LT(seen.farthest_m, 1.0) << magnet_uT;
    EXPECT_FALSE(out.flight.estimator().field_good());
    EXPECT_EQ(out.flight.state(), FlightState::flying);
    const Course landing = course(out, 25.0);
    EXPECT_EQ(out.flight.last_reason(), Reason::heading_by_gyro);
    EXPECT_EQ(out.flight.state(), FlightState::disarmed);
    EXPECT_LT(landing.farthest_m, 1.0) << magnet_uT;
  }
}

TEST(FieldGuard, AMagnetThatGoesIsForgottenAndALittleOneIsFlownBy) {
  Outdoors out;
  out.hover();
  out.vehicle.field_error_B_uT_ = {30, 0, 0};
  out.run(5.0);
  EXPECT_FALSE(out.flight.estimator().field_good());
  out.vehicle.field_error_B_uT_ = {8, 0, 0};  // what motors add
  out.run(0.3);
  EXPECT_FALSE(out.flight.estimator().field_good());
  out.run(0.3);
  EXPECT_TRUE(out.flight.estimator().field_good());
  out.run(25.0);
  EXPECT_EQ(out.flight.state(), FlightState::flying);
}

TEST(FieldGuard, AReadingThatIsNoNumberIsNone) {
  FieldGuard guard;
  guard.rests({23.0f, 0.0f, 53.0f});
  EXPECT_TRUE(guard.believe({23.0f, 1.0f, 53.0f}));
  EXPECT_FALSE(guard.believe({std::nanf(""), 0.0f, 53.0f}));
  guard.rests({std::nanf(""), 0.0f, 0.0f});
  for (unsigned i = 0; i < FieldGuard::kAgain; ++i) {
    EXPECT_EQ(guard.believe({23.0f, 1.0f, 53.0f}), i + 1 == FieldGuard::kAgain) << i;
  }
}

// By more than a right angle, which no gate can know: it would spiral outwards for good.
TEST(HeadingByMotion, OneThatIsWrongFromTheStartIsTurnedRightInTheAir) {
  for (const double angle_deg : {100.0, 140.0, -120.0}) {
    Outdoors out;
    const double a = angle_deg * M_PI / 180.0, declination = 12.4 * M_PI / 180.0;
    const Vector3d level(23.0 * std::cos(declination), 23.0 * std::sin(declination), 0.0);
    out.vehicle.field_error_B_uT_ = Eigen::AngleAxisd(a, Vector3d::UnitZ()) * level - level;
    out.vehicle.wind_W_ = {0, 2, 0};
    out.run(12.0);
    ASSERT_EQ(out.flight.arm(), Reason::none) << text_of(out.flight.ready_to_arm());
    out.run(1.0);
    ASSERT_EQ(out.flight.take_off(4.0f), Reason::none);
    const Course rise = course(out, 20.0), landing = course(out, 40.0);
    EXPECT_EQ(out.flight.state(), FlightState::disarmed) << angle_deg;
    EXPECT_LT(rise.farthest_m, 8.0) << angle_deg;
    EXPECT_LT(rise.steepest_rad, 0.7) << angle_deg;
    EXPECT_LT(landing.farthest_m, 1.0) << angle_deg;
    EXPECT_EQ(out.flight.last_reason(), Reason::heading_by_gyro) << angle_deg;
  }
}

// In a hover there is nothing to judge by, and a receiver that leaps is not motion.
TEST(HeadingByMotion, AsksForMotionAndForOneThatBothTell) {
  const auto after = [](float a_mps2, float turned_rad, float leap_mps) {
    HeadingByMotion heading;
    float told_rad = 0.0f;
    Vector3 v_W = Vector3::Zero();
    for (int i = 0; i < 50 && told_rad == 0.0f; ++i) {
      const float a = i / 5 % 2 ? -a_mps2 : a_mps2;  // to and fro
      for (int k = 0; k < 40; ++k) heading.feel({a, 0.3f * a, 0.0f}, 0.005f);
      v_W += 0.2f * a * Vector3(std::cos(turned_rad), std::sin(turned_rad), 0.0f) +
             0.06f * a * Vector3(-std::sin(turned_rad), std::cos(turned_rad), 0.0f);
      const float leap = i % 3 == 0 ? leap_mps : 0.0f;
      told_rad = heading.compare(v_W + Vector3(0.0f, leap, 0.0f), 0.0f);
    }
    return told_rad;
  };
  EXPECT_TRUE(near(after(2.0f, 1.2f, 0.0f), 1.2, stated(1e-3, "float")));
  EXPECT_TRUE(near(after(2.0f, -2.5f, 0.0f), -2.5, stated(1e-3, "float")));
  EXPECT_EQ(after(2.0f, 0.5f, 0.0f), 0.0f);  // flown with
  EXPECT_EQ(after(0.3f, 1.2f, 0.0f), 0.0f);
  EXPECT_EQ(after(0.0f, 0.0f, 3.0f), 0.0f);
}

TEST(OffCourse, AWindBeyondItsReachEndsInALevelLanding) {
  Outdoors out;
  out.hover();
  out.vehicle.push_W_N_ = {0, 12.0, 0};
  const Course blown = course(out, 6.0);
  EXPECT_EQ(out.flight.last_reason(), Reason::off_course);
  EXPECT_EQ(out.flight.state(), FlightState::failsafe);
  EXPECT_LT(out.vehicle.tilt_rad(), 0.35);
  EXPECT_GT(blown.farthest_m, 5.0);
}

TEST(PressureGuard, AnotherPressureForGoodIsFlownThrough) {
  for (const double error_Pa : {2000.0, -2000.0, 100.0, -100.0}) {
    Outdoors out;
    out.hover();
    out.vehicle.pressure_error_Pa_ = error_Pa;
    const Course seen = course(out, 20.0);
    EXPECT_GT(seen.lowest_m, 5.3) << error_Pa;
    EXPECT_LT(seen.highest_m, 6.7) << error_Pa;
    EXPECT_EQ(out.flight.state(), FlightState::flying) << error_Pa;
  }
}

// 20 Pa a second: a climb or a fall by 1.7 m/s that nobody has felt.
TEST(PressureGuard, APressureThatRunsAwayIsNotFollowedWhereTheReceiverTellsTheClimb) {
  for (const double rate_Paps : {20.0, -20.0}) {
    Outdoors out;
    out.hover();
    Course seen;
    for (int i = 0; i < 100; ++i) {
      out.vehicle.pressure_error_Pa_ += 0.1 * rate_Paps;
      const Course now = course(out, 0.1);
      seen.lowest_m = std::min(seen.lowest_m, now.lowest_m);
      seen.highest_m = std::max(seen.highest_m, now.highest_m);
    }
    EXPECT_GT(seen.lowest_m, 2.0) << rate_Paps;
    EXPECT_LT(seen.highest_m, 10.0) << rate_Paps;
    EXPECT_TRUE(out.flight.estimator().position_known()) << rate_Paps;
  }
}

TEST(CaptureGuard, AnotherBodysPoseOrATurnedOneIsNotFollowed) {
  struct Wrong {
    Vector3d by_m;
    double turned_rad;
  };
  for (const Wrong& wrong : {Wrong{{1.5, 0, 0}, 0.0}, Wrong{{0, 0, -1.0}, 0.0},
                             Wrong{{0, 0, 0}, M_PI / 2}, Wrong{{0.3, 0, 0}, M_PI}}) {
    Indoors in;
    in.vehicle.capture_error_m_ = wrong.by_m;
    in.vehicle.capture_turn_rad_ = wrong.turned_rad;
    const Course shortly = course(in, 0.4);
    EXPECT_LT(shortly.farthest_m, 0.05);
    EXPECT_EQ(in.flight.state(), FlightState::flying);
    in.vehicle.capture_error_m_.setZero();
    in.vehicle.capture_turn_rad_ = 0.0;
    const Course after = course(in, 2.0);
    EXPECT_LT(after.farthest_m, 0.1);
    EXPECT_EQ(in.flight.state(), FlightState::flying);
  }
}

TEST(CaptureGuard, OneThatStaysIsNoPositionAndItLands) {
  for (const double turned_rad : {0.0, M_PI / 2}) {
    Indoors in;
    in.vehicle.capture_error_m_ = {turned_rad > 0.0 ? 0.0 : 2.0, 0, 0};
    in.vehicle.capture_turn_rad_ = turned_rad;
    in.run(0.7);
    EXPECT_EQ(in.flight.state(), FlightState::failsafe);
    EXPECT_EQ(in.flight.last_reason(), Reason::no_position);
    const Course landing = course(in, 12.0);
    EXPECT_EQ(in.flight.state(), FlightState::disarmed);
    EXPECT_LT(landing.farthest_m, 2.5);
    EXPECT_LT(landing.steepest_rad, 0.5);
  }
}

}  // namespace
}  // namespace fw::test

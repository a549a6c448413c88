// Motors stopped in the air and started again: the rules, and the flight logic around a body that falls.
#include "firmware/flight/restart.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"
#include "firmware/tests/vehicle_model.hpp"

namespace fw::test {
namespace {

using whirl::near;
using whirl::stated, whirl::Tolerance;

constexpr Fall kGoodFall{
    .attitude_known = true, .speed_known = true, .height_m = 50.0f, .sinking_mps = 10.0f};

TEST(RestartRule, AGoodFallMayBeEnded) {
  EXPECT_EQ(why_not_restart(kGoodFall), Reason::none);
}

TEST(RestartRule, EachThingThatLacksRefuses) {
  Fall fall = kGoodFall;
  fall.attitude_known = false;
  EXPECT_EQ(why_not_restart(fall), Reason::attitude_lost);
  fall = kGoodFall;
  fall.speed_known = false;
  EXPECT_EQ(why_not_restart(fall), Reason::no_position);
  fall = kGoodFall;
  fall.esc_problem = Reason::esc_not_armed;
  EXPECT_EQ(why_not_restart(fall), Reason::esc_not_armed);
}

TEST(RestartRule, AllFourMayHaveStoppedButNotSome) {
  Fall fall = kGoodFall;
  for (unsigned failed = 0; failed <= 4; ++failed) {
    fall.rotors_failed = failed;
    const bool some = failed > 0 && failed < 4;
    EXPECT_EQ(why_not_restart(fall), some ? Reason::motor_out : Reason::none) << failed;
  }
}

// From 10 m/s: 0.6 s at 13 m/s in the mean, then 15.9 m/s braked by 11.8 m/s^2, and 3 m.
TEST(RestartRule, HeightIsWhatBrakingTakes) {
  const Tolerance by_hand = stated(0.1, "by hand");
  EXPECT_TRUE(near(restart_height_m(10.0f, 0.0f, 0.0f), 7.77 + 10.7 + 3.0, by_hand));
  EXPECT_LT(restart_height_m(0.0f, 0.0f, 0.0f), 7.0f);
  // Still on its way up.
  EXPECT_EQ(restart_height_m(-5.0f, 0.4f, 0.0f), restart_height_m(0.0f, 0.0f, 0.0f));
  Fall fall = kGoodFall;
  fall.height_m = restart_height_m(fall.sinking_mps, 0.0f, 0.0f) - 0.1f;
  EXPECT_EQ(why_not_restart(fall), Reason::too_low);
  fall.height_m += 0.2f;
  EXPECT_EQ(why_not_restart(fall), Reason::none);
  // On its back it turns for 0.88 s first, which ends at 24.6 m/s: 25.6 m, 25.5 m, and 3 m.
  fall.tilt_rad = 3.14159f;
  EXPECT_EQ(why_not_restart(fall), Reason::too_low);
  EXPECT_TRUE(near(restart_height_m(10.0f, 3.14159f, 0.0f), 54.2, by_hand));
  fall.height_m = std::nanf("");
  EXPECT_EQ(why_not_restart(fall), Reason::too_low);
}

// Of 0.02 /m the air holds 2 m/s^2 against 10 m/s: 1.48 s at 7.8 m/s^2 end at 21.6 m/s: 23.4 m, 19.8 m, and 3 m.
TEST(RestartRule, AirThatWasFeltTakesOffHeight) {
  EXPECT_TRUE(near(restart_height_m(10.0f, 3.14159f, 0.02f), 46.2, stated(0.1, "by hand")));
  // A dive beyond the speed that the air allows is not slowed by the formula: 18 m, 38.1 m, and 3 m.
  EXPECT_TRUE(near(restart_height_m(30.0f, 0.0f, 0.02f), 59.1, stated(0.1, "by hand")));
  Fall fall = kGoodFall;
  fall.height_m = 20.9f;  // falling freely, 21.5 m
  EXPECT_EQ(why_not_restart(fall), Reason::too_low);
  fall.drag_pm = 0.02f;
  EXPECT_EQ(why_not_restart(fall), Reason::none);
}

void fall_for_a_second(FallDrag& drag, float upward_mps2, float sinking_mps) {
  for (int i = 0; i < 200; ++i) drag.step(upward_mps2, sinking_mps, 0.005f);
}

TEST(FallDrag, IsTheLeastThatWasFelt) {
  FallDrag drag;
  drag.start();
  fall_for_a_second(drag, 1.0f, 9.0f);  // too slow to tell
  EXPECT_EQ(drag.least_pm(), 0.0f);
  const Tolerance mean = stated(1e-5, "ten means of 0.1 s");
  fall_for_a_second(drag, 9.0f, 9.0f);
  fall_for_a_second(drag, 9.0f, 15.0f);
  EXPECT_TRUE(near(drag.least_pm(), 0.04, mean));
  fall_for_a_second(drag, 4.5f, 15.0f);  // on its edge
  fall_for_a_second(drag, 9.0f, 15.0f);
  EXPECT_TRUE(near(drag.least_pm(), 0.02, mean));
  fall_for_a_second(drag, -1.0f, 15.0f);  // an accelerometer's zero
  EXPECT_EQ(drag.least_pm(), 0.0f);
  drag.start();
  fall_for_a_second(drag, std::nanf(""), std::nanf(""));
  EXPECT_EQ(drag.least_pm(), 0.0f);
}

struct High {
  explicit High(double height_m) : vehicle(Scenario{}) {
    flight.parameters().set(Parameter::fence_top_m, 60.0f);
    flight.parameters().set(Parameter::fence_north_m,
                            0.0f);  // whoever turns upright is thrown aside
    flight.parameters().set(Parameter::fence_east_m, 0.0f);
    vehicle.run(flight, 3.0);
    EXPECT_EQ(flight.arm(), Reason::none) << text_of(flight.ready_to_arm());
    vehicle.run(flight, 2.0);
    EXPECT_EQ(flight.take_off(1.1f), Reason::none);
    const auto z_m = static_cast<float>(-height_m);
    for (int i = 0; i < 100'000 && -vehicle.p_W_.z() < height_m - 0.1; ++i) {
      if (i % 100 == 0) flight.on_target({0.0f, 0.0f, z_m}, 0.0f);
      if (i % 1000 == 0) flight.on_link();
      vehicle.step(flight);
    }
  }
  Flight flight;
  VehicleModel vehicle;
};

TEST(Restart, EndsAFallAndHolds) {
  High high(20.0);
  ASSERT_EQ(high.flight.kill(), Reason::none);
  EXPECT_EQ(high.flight.state(), FlightState::disarmed);
  EXPECT_EQ(high.flight.last_reason(), Reason::killed);
  high.vehicle.run(high.flight, 0.6);
  EXPECT_EQ(high.flight.setpoints(), (std::array<std::uint16_t, 4>{}));
  EXPECT_GT(high.vehicle.v_W_.z(), 4.0);
  EXPECT_EQ(high.flight.arm(), Reason::falling);
  EXPECT_EQ(high.flight.calibrate(Calibration::gyro), Reason::falling);
  ASSERT_EQ(high.flight.restart(), Reason::none) << text_of(high.flight.last_reason());
  double lowest_m = 100.0;
  for (int i = 0; i < 6000; ++i) {
    if (i % 500 == 0) high.flight.on_link();
    high.vehicle.step(high.flight);
    lowest_m = std::min(lowest_m, -high.vehicle.p_W_.z());
  }
  EXPECT_GT(lowest_m, 5.0);
  EXPECT_LT(high.vehicle.v_W_.norm(), 0.5);
  EXPECT_EQ(high.flight.state(), FlightState::flying);
}

// Kicked as it is stopped: by the time of the restart it lies on its side or beyond, and turns on.
TEST(Restart, RightsItselfFromItsSideAndFromBeyond) {
  // From beyond its side it is thrown aside at 7 m/s as it turns, and leans against that by 50 degrees at once.
  for (const double kick_radps : {-1.9, 1.9, -3.3, 3.3}) {
    const bool beyond = std::abs(kick_radps) > 2.0;
    High high(30.0);
    ASSERT_EQ(high.flight.kill(), Reason::none);
    high.vehicle.w_B_.y() = kick_radps;
    high.vehicle.run(high.flight, 0.6);
    ASSERT_GT(high.vehicle.tilt_rad(), beyond ? 1.9 : 1.0);
    ASSERT_EQ(high.flight.restart(), Reason::none) << text_of(high.flight.restart());
    double fastest_radps = 0.0, lowest_m = 100.0;
    for (int i = 0; i < 5000; ++i) {
      if (i % 500 == 0) high.flight.on_link();
      high.vehicle.step(high.flight);
      fastest_radps = std::max(fastest_radps, high.vehicle.w_B_.norm());
      lowest_m = std::min(lowest_m, -high.vehicle.p_W_.z());
    }
    EXPECT_LT(fastest_radps, beyond ? 10.0 : 6.0);
    EXPECT_GT(lowest_m, 10.0);
    EXPECT_LT(high.vehicle.tilt_rad(), 0.1);
    EXPECT_EQ(high.flight.state(), FlightState::flying);
  }
}

// In air that lets it fall at no more than 14 m/s: from 12.8 m/s, 22 m above the ground. Falling freely it would be
// refused below 27 m.
TEST(Restart, CountsWithTheAirThatItsAccelerometerFeels) {
  High high(40.0);
  ASSERT_EQ(high.flight.kill(), Reason::none);
  while (-high.vehicle.p_W_.z() > 22.0) {
    const Eigen::Vector3d& v_W = high.vehicle.v_W_;
    high.vehicle.push_W_N_ = -0.9 * 0.05 * v_W.norm() * v_W;
    high.vehicle.step(high.flight);
  }
  EXPECT_GT(high.vehicle.v_W_.z(), 12.0);
  EXPECT_EQ(high.flight.restart(), Reason::none) << text_of(high.flight.restart());
  high.vehicle.push_W_N_.setZero();
  double lowest_m = 100.0;
  for (int i = 0; i < 5000; ++i) {
    if (i % 500 == 0) high.flight.on_link();
    high.vehicle.step(high.flight);
    lowest_m = std::min(lowest_m, -high.vehicle.p_W_.z());
  }
  EXPECT_GT(lowest_m, 3.0);
}

TEST(Restart, IsRefusedLow) {
  High high(1.1);
  ASSERT_EQ(high.flight.kill(), Reason::none);
  high.vehicle.run(high.flight, 0.1);
  EXPECT_EQ(high.flight.restart(), Reason::too_low);
}

TEST(Restart, IsRefusedWithOneMotorLostThoughItsEscIsBack) {
  High high(10.0);
  high.vehicle.esc_on_[1] = false;
  for (int i = 0; i < 900 && high.flight.state() != FlightState::disarmed; ++i) {
    high.vehicle.step(high.flight);
  }
  ASSERT_EQ(high.flight.state(), FlightState::disarmed);
  high.vehicle.run(high.flight, 0.5);
  high.vehicle.esc_on_[1] = true;
  high.vehicle.q_WB_.setIdentity();  // whatever else it did
  high.vehicle.w_B_.setZero();
  high.vehicle.run(high.flight, 0.1);
  EXPECT_EQ(high.flight.restart(), Reason::motor_out);
  EXPECT_EQ(high.flight.state(), FlightState::disarmed);
}

TEST(Restart, WhatFellAndLiesStillArmsAsUsual) {
  High high(1.1);
  ASSERT_EQ(high.flight.kill(), Reason::none);
  high.vehicle.run(high.flight, 0.3);
  EXPECT_TRUE(high.flight.falling());
  high.vehicle.run(high.flight, 6.0);
  EXPECT_FALSE(high.flight.falling());
  EXPECT_EQ(high.flight.restart(), Reason::none) << text_of(high.flight.ready_to_arm());
  EXPECT_EQ(high.flight.state(), FlightState::armed);  // on the ground force is plain arming
}

}  // namespace
}  // namespace fw::test

// The whole flight logic around a rigid body of other hands (vehicle_model.hpp).
#include <gtest/gtest.h>

#include <vector>

#include "base/near.hpp"
#include "firmware/config/vehicle.hpp"
#include "firmware/tests/vehicle_model.hpp"

namespace fw::test {
namespace {

using whirl::near;
using whirl::stated;

struct Errors {
  double height_rms_m = 0, sideways_rms_m = 0, tilt_rms_rad = 0;
};

Errors hover_errors(VehicleModel& vehicle, Flight& flight, double seconds) {
  Errors sum;
  const int steps = static_cast<int>(seconds * 1000);
  for (int i = 0; i < steps; ++i) {
    vehicle.step(flight);
    sum.height_rms_m += std::pow(vehicle.p_W_.z() + 1.1, 2) / steps;
    sum.sideways_rms_m += vehicle.p_W_.head<2>().squaredNorm() / steps;
    sum.tilt_rms_rad += std::pow(vehicle.tilt_rad(), 2) / steps;
  }
  return {std::sqrt(sum.height_rms_m), std::sqrt(sum.sideways_rms_m), std::sqrt(sum.tilt_rms_rad)};
}

// Flies itself into a hover at 1.1 m.
struct Hovering {
  explicit Hovering(const Scenario& scenario) : vehicle(scenario) {
    vehicle.run(flight, 3.0);
    EXPECT_EQ(flight.arm(), Reason::none) << text_of(flight.ready_to_arm());
    vehicle.run(flight, 1.0);
    EXPECT_EQ(flight.take_off(1.1f), Reason::none);
    for (int i = 0; i < 8000; ++i) {
      vehicle.step(flight);
      highest_m = std::max(highest_m, -vehicle.p_W_.z());
    }
  }
  Flight flight;
  VehicleModel vehicle;
  double highest_m = 0.0;
};

double bounce_after_touchdown(VehicleModel& vehicle, Flight& flight) {
  double bounce = 0.0;
  bool touched = false;
  for (int i = 0; i < 12'000 && flight.state() != FlightState::disarmed; ++i) {
    vehicle.step(flight);
    const double clearance = -vehicle.p_W_.z() - VehicleModel::kFoot_m;
    touched = touched || clearance < 0.0;
    if (touched) bounce = std::max(bounce, clearance);
  }
  return bounce;
}

class ThrustError : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(RotorsWeakAndStrong, ThrustError, ::testing::Values(0.88, 1.0, 1.12));

TEST_P(ThrustError, HoversThroughAGustAndLandsWithoutABounce) {
  Hovering hover({.thrust_gain = GetParam(), .seed = 7});
  EXPECT_LT(hover.highest_m, 1.1 + 0.06);  // reached without much overshoot
  hover.vehicle.wind_W_ = {0, 2.0, 0};
  hover.vehicle.run(hover.flight, 1.0);
  hover.vehicle.wind_W_.setZero();
  hover.vehicle.run(hover.flight, 3.0);
  EXPECT_LT(hover.vehicle.p_W_.head<2>().norm(), 0.10);
  hover.vehicle.run(hover.flight, 2.0);
  const Errors errors = hover_errors(hover.vehicle, hover.flight, 10.0);
  EXPECT_LT(errors.height_rms_m, 0.05);
  EXPECT_LT(errors.sideways_rms_m, 0.10);
  EXPECT_LT(errors.tilt_rms_rad, 3.0 * M_PI / 180.0);
  ASSERT_EQ(hover.flight.land(), Reason::none);
  EXPECT_LT(bounce_after_touchdown(hover.vehicle, hover.flight), 0.05);
  EXPECT_EQ(hover.flight.last_reason(), Reason::landed);
  EXPECT_EQ(hover.flight.setpoints(), (std::array<std::uint16_t, 4>{}));
}

TEST(Flight, FollowsATargetASideWithoutOvershoot) {
  Hovering hover({});
  double furthest = 0.0;
  for (int i = 0; i < 6000; ++i) {
    if (i % 100 == 0) hover.flight.on_target({1.0f, 0.0f, -1.1f}, 0.5f);
    hover.vehicle.step(hover.flight);
    furthest = std::max(furthest, hover.vehicle.p_W_.x());
  }
  EXPECT_TRUE(near(hover.vehicle.p_W_.x(), 1.0, stated(0.05, "5 cm: the sensors' noise and bias")));
  EXPECT_LT(furthest, 1.1);
  EXPECT_TRUE(near(yaw_of(hover.vehicle.q_WB_.cast<float>()), 0.5,
                   stated(0.05, "3 deg: the sensors' noise and bias")));
}

TEST(Flight, FliesToATrajectoryThatJumpsBeforeItFollows) {
  Hovering hover({});
  double fastest_mps = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Vector3 p_W_m(i < 1000 ? 0.0f : 5.0f, 0.0f, -1.1f);
    if (i % 100 == 0) hover.flight.on_trajectory({.p_W_m = p_W_m});
    hover.vehicle.step(hover.flight);
    fastest_mps = std::max(fastest_mps, hover.vehicle.v_W_.norm());
  }
  EXPECT_LT(fastest_mps, 1.5 * config::kSpeedLimit_mps);
}

// A point was valid when its 65 bytes began on a line of 57600 baud; the vehicle looks every 5 ms.
TEST(Flight, IsWhereATrajectoryIsNowNotWhereItWasToldToBe) {
  constexpr double kSpeed_mps = 0.8, kTold_s = 65 * 10 / 57600.0 + 0.5 * 0.005;
  Hovering hover({});
  const Vector3 from_W_m = hover.flight.reference().p_W_m();
  hover.flight.on_trajectory(
      {.p_W_m = from_W_m, .v_W_mps = {static_cast<float>(kSpeed_mps), 0.0f, 0.0f}});
  int ms = 0;
  while (hover.flight.reference().p_W_m() == from_W_m && ms < 100) {
    hover.vehicle.step(hover.flight);
    ++ms;
  }
  EXPECT_TRUE(near((hover.flight.reference().p_W_m() - from_W_m).x(),
                   kSpeed_mps * (1e-3 * ms + kTold_s),
                   stated(kSpeed_mps * 1.5e-3, "a tick, and what a whole millisecond rounds off")));
}

// What its ESCs draw (half an ampere each, vehicle_model.hpp) counts with the parameter's resistance.
TEST(Flight, TheBatteryAtRestIsReckonedWithWhatTheEscsDraw) {
  Hovering hover({});
  ASSERT_TRUE(hover.flight.parameters().set(Parameter::bat_resistance_ohm, 0.05f));
  hover.vehicle.run(hover.flight, 5.0);
  const BatteryWatch& battery = hover.flight.battery();
  EXPECT_TRUE(near(battery.rest_V() - battery.voltage_V(), 4 * 0.5 * 0.05,
                   stated(1e-4, "ten times the filter's length, and floats")));
}

TEST(Flight, StopsItsMotorsWithinASecondOfTouchdown) {
  Hovering hover({});
  ASSERT_EQ(hover.flight.land(), Reason::none);
  int until_touched = 0, until_stopped = 0;
  for (int ms = 0; ms < 12'000 && until_stopped == 0; ++ms) {
    hover.vehicle.step(hover.flight);
    const bool touches = hover.vehicle.p_W_.z() > -VehicleModel::kFoot_m;
    if (touches && until_touched == 0) until_touched = ms;
    if (hover.flight.state() == FlightState::disarmed) until_stopped = ms;
  }
  ASSERT_GT(until_touched, 0);
  EXPECT_GT(until_stopped, until_touched);  // not before
  EXPECT_LT(until_stopped - until_touched, 1000);
}

TEST(Flight, LosesTheCaptureAndLandsBlind) {
  Hovering hover({});
  hover.vehicle.capture_on_ = false;
  hover.vehicle.run(hover.flight, 0.6);
  EXPECT_EQ(hover.flight.state(), FlightState::failsafe);
  EXPECT_EQ(hover.flight.last_reason(), Reason::no_position);
  double fastest = 0.0;
  for (int i = 0; i < 12'000 && hover.flight.state() == FlightState::failsafe; ++i) {
    hover.vehicle.step(hover.flight);
    fastest = std::max(fastest, hover.vehicle.v_W_.z());
  }
  EXPECT_EQ(hover.flight.state(), FlightState::disarmed);
  EXPECT_GT(hover.vehicle.p_W_.z(), -VehicleModel::kFoot_m - 0.02);  // on the ground, not above it
  EXPECT_LT(fastest, 1.0);
  EXPECT_LT(hover.vehicle.tilt_rad(), 0.1);
}

// The cameras' computer goes on sending the last pose that it had.
TEST(Flight, LandsWhenTheCaptureStaysTheSame) {
  Hovering hover({});
  hover.vehicle.wind_W_ = {0, 1.0, 0};
  hover.vehicle.capture_stuck_ = true;
  hover.vehicle.run(hover.flight, 1.0);
  EXPECT_EQ(hover.flight.last_reason(), Reason::no_position);
  hover.vehicle.run(hover.flight, 12.0);
  EXPECT_EQ(hover.flight.state(), FlightState::disarmed);
}

TEST(Flight, CutsTheMotorsAtOnceWhenAnEscSaysThatItsMotorStandsAndTellsWhy) {
  const struct {
    std::uint8_t flags;
    Reason reason;
  } table[] = {{esc::flag_armed, Reason::motor_out},
               {0, Reason::motor_out},
               {esc::flag_desync, Reason::motor_out},
               {esc::flag_over_current | esc::flag_turning, Reason::esc_over_current},
               {esc::flag_over_current, Reason::esc_over_current}};
  for (const auto& row : table) {
    Hovering hover({});
    hover.vehicle.esc_on_[2] = false;
    hover.flight.on_esc_status(2, {0, 0, row.flags});
    hover.vehicle.run(hover.flight, 0.01);
    EXPECT_EQ(hover.flight.state(), FlightState::disarmed);
    EXPECT_EQ(hover.flight.last_reason(), row.reason) << text_of(row.reason);
    EXPECT_TRUE(hover.flight.emergency());
    // Nor is it a fall that a restart could end: three are left.
    hover.vehicle.esc_on_[2] = true;
    hover.vehicle.run(hover.flight, 0.05);
    EXPECT_EQ(hover.flight.restart(), Reason::motor_out);
  }
}

TEST(Flight, LandsWithABatteryThatIsLowAndDoesNotArmWithIt) {
  Hovering hover({});
  hover.vehicle.battery_V_ = 14.3;
  hover.vehicle.run(hover.flight, 2.0);
  EXPECT_EQ(hover.flight.state(), FlightState::flying);  // a moment is no state of charge
  hover.vehicle.run(hover.flight, 4.0);
  EXPECT_EQ(hover.flight.state(), FlightState::landing);
  EXPECT_EQ(hover.flight.last_reason(), Reason::battery_low);
  hover.vehicle.run(hover.flight, 10.0);
  EXPECT_EQ(hover.flight.state(), FlightState::disarmed);
  hover.vehicle.run(hover.flight, 3.0);
  EXPECT_EQ(hover.flight.arm(), Reason::battery_low);
}

TEST(Flight, AnEmptyBatteryIsAFailSafe) {
  Hovering hover({});
  hover.vehicle.battery_V_ = 13.0;
  hover.vehicle.run(hover.flight, 5.0);
  EXPECT_EQ(hover.flight.state(), FlightState::failsafe);
  EXPECT_EQ(hover.flight.last_reason(), Reason::battery_empty);
}

TEST(Flight, WarnsOfAMissingBarometerAndMagnetometerAndFliesOn) {
  Hovering hover({});
  EXPECT_EQ(hover.flight.take_warning(), Reason::none);
  hover.vehicle.pressure_on_ = hover.vehicle.field_on_ = false;
  hover.vehicle.run(hover.flight, 1.0);
  EXPECT_EQ(hover.flight.take_warning(), Reason::no_pressure);
  EXPECT_EQ(hover.flight.take_warning(), Reason::no_field);
  EXPECT_EQ(hover.flight.state(), FlightState::flying);
}

TEST(Flight, ATargetBeyondTheFenceIsDrawnInside) {
  Hovering hover({});
  for (int i = 0; i < 100; ++i) {
    hover.flight.on_target({9.0f, -9.0f, -9.0f}, 0.0f);
    hover.vehicle.run(hover.flight, 0.1);
  }
  EXPECT_EQ(hover.flight.state(), FlightState::flying);
  EXPECT_TRUE(near(hover.vehicle.p_W_.x(), 2.1, stated(0.06, "the sensors' noise and bias")));
  EXPECT_TRUE(near(hover.vehicle.p_W_.y(), -1.6, stated(0.06, "the sensors' noise and bias")));
  EXPECT_TRUE(near(hover.vehicle.p_W_.z(), -2.6, stated(0.06, "the sensors' noise and bias")));
}

TEST(Flight, AVelocityTowardsTheFenceEndsBeforeIt) {
  Hovering hover({});
  for (int i = 0; i < 100; ++i) {
    hover.flight.on_velocity({1.0f, 0.0f, 0.0f}, -1.1f, 0.0f);
    hover.vehicle.run(hover.flight, 0.1);
    EXPECT_LT(hover.vehicle.p_W_.x(), 2.3);
  }
  EXPECT_GT(hover.vehicle.p_W_.x(), 1.9);
  EXPECT_EQ(hover.flight.state(), FlightState::flying);
}

TEST(Flight, BlownOutOfTheFenceItLandsBackInside) {
  Hovering hover({});
  hover.vehicle.push_W_N_.x() = 9.0;
  for (int ms = 0; ms < 5000 && hover.vehicle.p_W_.x() < 2.7; ++ms)
    hover.vehicle.step(hover.flight);
  hover.vehicle.push_W_N_.setZero();
  hover.vehicle.run(hover.flight, 1.0);
  EXPECT_EQ(hover.flight.state(), FlightState::failsafe);
  EXPECT_EQ(hover.flight.last_reason(), Reason::outside_fence);
  hover.vehicle.run(hover.flight, 12.0);
  EXPECT_EQ(hover.flight.state(), FlightState::disarmed);
  EXPECT_LT(hover.vehicle.p_W_.x(), 2.3);
}

TEST(Flight, LandsWhenTheStationFallsSilentThoughItKnowsWhereItIs) {
  Hovering hover({});
  hover.flight.on_link();
  hover.vehicle.run(hover.flight, 2.9);
  EXPECT_EQ(hover.flight.state(), FlightState::flying);
  hover.vehicle.run(hover.flight, 0.2);
  EXPECT_EQ(hover.flight.state(), FlightState::landing);
  EXPECT_EQ(hover.flight.last_reason(), Reason::no_link);
}

TEST(Flight, CutsTheMotorsWhenTheImuDies) {
  Hovering hover({});
  hover.vehicle.imu_on_ = false;
  hover.vehicle.run(hover.flight, 0.04);
  EXPECT_EQ(hover.flight.state(), FlightState::disarmed);
  EXPECT_EQ(hover.flight.last_reason(), Reason::imu_not_running);
  EXPECT_TRUE(hover.flight.emergency());
  EXPECT_EQ(hover.flight.setpoints(), (std::array<std::uint16_t, 4>{}));
}

TEST(Flight, CutsTheMotorsWhenTheImuFreezes) {
  Hovering hover({});
  hover.flight.set_imu_frozen(true);
  hover.vehicle.run(hover.flight, 0.01);
  EXPECT_EQ(hover.flight.state(), FlightState::disarmed);
  EXPECT_EQ(hover.flight.last_reason(), Reason::imu_frozen);
}

// Weak on one side for good: no control can hold that, and the rotors must not go on in the grass.
TEST(Flight, CutsTheMotorsWhenTippedOver) {
  Hovering hover({});
  hover.vehicle.esc_on_[1] = false;
  std::vector<double> tilt_rad;
  for (int i = 0; i < 3000 && hover.flight.state() != FlightState::disarmed; ++i) {
    hover.vehicle.step(hover.flight);
    hover.flight.on_esc_answered(1);  // it answers, but its motor has stopped
    tilt_rad.push_back(hover.vehicle.tilt_rad());
  }
  EXPECT_EQ(hover.flight.state(), FlightState::disarmed);
  EXPECT_EQ(hover.flight.last_reason(), Reason::tipped_over);
  // 60 degrees lie 100 ms back: steps of 5 ms of which the first counts, 2 ms of the IMU, and the filter.
  ASSERT_GT(tilt_rad.size(), 120u);
  EXPECT_LT(*(tilt_rad.end() - 120), M_PI / 3.0);
  EXPECT_GT(*(tilt_rad.end() - 90), M_PI / 3.0);
}

TEST(Flight, DoesNotArmBeforeItsFiltersHaveConverged) {
  Flight flight;
  VehicleModel vehicle({});
  vehicle.run(flight, 3.0);
  ASSERT_EQ(flight.ready_to_arm(), Reason::none) << text_of(flight.ready_to_arm());
  flight.parameters().set(Parameter::est_start_scale, 0.6f);
  vehicle.run(flight, 0.5);
  EXPECT_EQ(flight.arm(), Reason::estimate_not_converged);
  vehicle.run(flight, 20.0);
  EXPECT_EQ(flight.arm(), Reason::none) << text_of(flight.ready_to_arm());
}

TEST(Flight, GivesUpWhenAnEscFallsSilent) {
  Hovering hover({});
  hover.vehicle.esc_on_[1] = false;
  hover.vehicle.run(hover.flight, 1.5);
  EXPECT_TRUE(hover.flight.last_reason() == Reason::esc_silent ||
              hover.flight.last_reason() == Reason::tipped_over);
  hover.vehicle.run(hover.flight, 12.0);
  EXPECT_EQ(hover.flight.state(), FlightState::disarmed);
}

TEST(Flight, LandsWhenTargetsStop) {
  Hovering hover({});
  hover.flight.on_target({0, 0, -1.1f}, 0);
  hover.vehicle.run(hover.flight, 3.1);
  EXPECT_EQ(hover.flight.state(), FlightState::landing);
  EXPECT_EQ(hover.flight.last_reason(), Reason::no_setpoints);
}

TEST(Flight, TakesOffForATargetInTheAirAndLandsForOneOnTheGround) {
  Flight flight;
  VehicleModel vehicle({});
  vehicle.run(flight, 3.0);
  ASSERT_EQ(flight.arm(), Reason::none);
  const auto fly_to = [&](float z, double seconds) {
    for (int i = 0; i < static_cast<int>(10 * seconds); ++i) {
      flight.on_target({0, 0, z}, 0);
      vehicle.run(flight, 0.1);
    }
  };
  fly_to(-1.1f, 9.0);
  EXPECT_TRUE(near(vehicle.p_W_.z(), -1.1, stated(0.05, "5 cm: the sensors' noise and bias")));
  fly_to(0.0f, 8.0);
  EXPECT_EQ(flight.state(), FlightState::disarmed);
  EXPECT_EQ(flight.last_reason(), Reason::landed);
}

}  // namespace
}  // namespace fw::test

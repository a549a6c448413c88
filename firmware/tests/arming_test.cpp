// What the flight logic does not begin with, by name, around a rigid body of other hands (vehicle_model.hpp).
#include <gtest/gtest.h>

#include <cmath>

#include "firmware/tests/vehicle_model.hpp"

namespace fw::test {
namespace {

TEST(Flight, RefusesToArmAndSaysWhy) {
  Flight flight;
  EXPECT_EQ(flight.arm(), Reason::imu_not_running);
  VehicleModel vehicle({});
  vehicle.capture_on_ = false;
  vehicle.run(flight, 3.0);
  EXPECT_EQ(flight.arm(), Reason::no_position);
  vehicle.capture_on_ = true;
  vehicle.run(flight, 0.3);
  EXPECT_EQ(flight.arm(), Reason::imu_not_calibrated);
  vehicle.run(flight, 2.0);
  vehicle.pressure_on_ = false;
  vehicle.run(flight, 0.3);
  EXPECT_EQ(flight.arm(), Reason::no_pressure);
  vehicle.pressure_on_ = true;
  vehicle.field_on_ = false;
  vehicle.run(flight, 0.3);
  EXPECT_EQ(flight.arm(), Reason::no_field);
  vehicle.field_on_ = true;
  vehicle.battery_V_ = 14.0;
  vehicle.run(flight, 3.0);
  EXPECT_EQ(flight.arm(), Reason::battery_low);
  vehicle.battery_V_ = 0.0;
  vehicle.run(flight, 3.0);
  EXPECT_EQ(flight.arm(), Reason::no_battery);
  vehicle.battery_V_ = 16.4;
  vehicle.run(flight, 6.0);
  flight.on_esc_status(2, {0, 0, esc::flag_armed | esc::flag_under_voltage});
  EXPECT_EQ(flight.arm(), Reason::esc_fault);
  flight.on_esc_status(2, {0, 0, esc::flag_over_current});
  EXPECT_EQ(flight.arm(), Reason::esc_over_current);
  flight.on_esc_status(2, {0, 0, 0});
  EXPECT_EQ(flight.arm(), Reason::esc_not_armed);
  EXPECT_EQ(flight.take_off(1.1f), Reason::wrong_state);
  vehicle.esc_on_[3] = false;
  vehicle.run(flight, 0.6);
  EXPECT_EQ(flight.arm(), Reason::esc_silent);
}

// The library is built for thrust by speed, which no current has a part in.
TEST(Flight, BySpeedItArmsWithEscsThatWereNeverCalibrated) {
  Flight flight;
  VehicleModel vehicle({});
  vehicle.run(flight, 3.0);
  for (unsigned i = 0; i < 4; ++i) {
    flight.on_esc_status(i, {0, 0, esc::flag_armed | esc::flag_uncalibrated});
  }
  EXPECT_EQ(flight.arm(), Reason::none);
}

TEST(Flight, RefusesATakeOffToNoSensibleHeightByName) {
  Flight flight;
  VehicleModel vehicle({});
  vehicle.run(flight, 3.0);
  ASSERT_EQ(flight.arm(), Reason::none);
  for (const float height_m : {0.0f, 0.3f, -1.0f, 10.0f, 1e9f, std::nanf("")}) {
    EXPECT_EQ(flight.take_off(height_m), Reason::height_out_of_range) << height_m;
    EXPECT_EQ(flight.state(), FlightState::armed);
  }
  EXPECT_EQ(flight.take_off(0.31f), Reason::none);
}

}  // namespace
}  // namespace fw::test

// What a part senses that is soldered to the board in one way or another.
#include "io_bridges/rack/models/inertial_sensor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace whirl::rack {
namespace {

io::Mpu6000::Truth sensed(const std::vector<std::string>& axes) {
  InertialSensor sensor(plant::ImuParams{}, mounting_of(axes), 1, "imu");
  io::BodyMotion motion;
  for (int i = 0; i < 3; ++i) {
    motion.specific_force_B_mps2[i] = i + 1.0;
    motion.w_WB_B_radps[i] = 10.0 * (i + 1);
  }
  sensor.set_motion(motion, 0);
  return sensor.sample(0);
}

TEST(InertialSensor, EveryRotorThatAVehicleMayHaveShakesIt) {
  for (int rotor = 0; rotor < io::kMostMotors; ++rotor) {
    plant::ImuParams params;
    params.accelerometer.vibration_per_radps2 = 1e-5;
    InertialSensor sensor(params, mounting_of({"+x", "+y", "+z"}), 1, "imu");
    io::BodyMotion motion;
    motion.rotor_speed_radps[rotor] = 400.0;
    double most_mps2 = 0.0;
    for (int ms = 0; ms < 20; ++ms) {
      sensor.set_motion(motion, ms * 1'000'000);
      most_mps2 =
          std::max(most_mps2, std::abs(sensor.sample(ms * 1'000'000).specific_force_mps2[2]));
    }
    EXPECT_GT(most_mps2, 0.1) << rotor;  // 1e-5 x 400^2 = 1.6
  }
}

TEST(InertialSensor, APartSensesAlongItsOwnAxes) {
  using Three = std::array<double, 3>;
  const auto usual = sensed({"+x", "-y", "-z"});  // forward, left, up
  EXPECT_EQ(usual.specific_force_mps2, (Three{1.0, -2.0, -3.0}));
  EXPECT_EQ(usual.rate_radps, (Three{10.0, -20.0, -30.0}));
  EXPECT_EQ(sensed({"+x", "+y", "+z"}).specific_force_mps2, (Three{1.0, 2.0, 3.0}));
  const auto turned = sensed({"-y", "+x", "+z"});  // a quarter turn about z
  EXPECT_EQ(turned.specific_force_mps2, (Three{-2.0, 1.0, 3.0}));
  EXPECT_EQ(turned.rate_radps, (Three{-20.0, 10.0, 30.0}));
}

}  // namespace
}  // namespace whirl::rack

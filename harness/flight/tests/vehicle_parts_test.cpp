#include "harness/flight/vehicle_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "plant/parts/vehicle.hpp"

namespace whirl::flight {
namespace {

FlightParams quad(plant::ToleranceClass tolerance) {
  FlightParams params;
  params.vehicle = plant::hp_quad();
  for (const char* group : plant::vehicle_groups()) params.tolerance[group] = tolerance;
  return params;
}

BoardDescription board_with_imu() {
  BoardDescription board;
  board.devices = {{.name = "imu",
                    .type = "mpu6000",
                    .keys = {{"params.place", std::vector<double>{0.01, 0.0, 0.0}}}}};
  return board;
}

TEST(VehicleParts, WithoutAToleranceTheDrawingFlies) {
  FlightParams params = quad(plant::ToleranceClass::none);
  draw_parts(params, 1);
  EXPECT_TRUE(params.drawn.empty());
  EXPECT_TRUE(params.vehicle.motors.empty());
  EXPECT_EQ(params.vehicle.airframe.mass_kg, 0.9);
  BoardDescription board = board_with_imu();
  set_parts(board, params);
  EXPECT_EQ(board.devices[0].keys.size(), 1u);
  EXPECT_EQ(board.hse_error, 0.0);
}

TEST(VehicleParts, FourMotorsAreFourCopies) {
  FlightParams params = quad(plant::ToleranceClass::typical);
  draw_parts(params, 1);
  ASSERT_EQ(params.vehicle.motors.size(), 4u);
  ASSERT_TRUE(plant::validate(params.vehicle, "quad").ok());
  for (std::size_t i = 0; i < 4; ++i) {
    const double kt = params.vehicle.motors[i].torque_constant_NmpA;
    EXPECT_TRUE(near(kt, 0.01005, stated(0.05 * 0.01005, "makers' Kv")));
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NE(kt, params.vehicle.motors[j].torque_constant_NmpA);
      EXPECT_NE(params.vehicle.airframe.rotors[i].thrust_error,
                params.vehicle.airframe.rotors[j].thrust_error);
    }
  }
}

// The hubs and the IMU keep their distances: it is the centre of mass that lies elsewhere.
TEST(VehicleParts, CentreOfMassMovesAgainstEverythingElse) {
  FlightParams params = quad(plant::ToleranceClass::none);
  params.tolerance["body"] = plant::ToleranceClass::worst;
  draw_parts(params, 3);
  const auto& rotors = params.vehicle.airframe.rotors;
  const Eigen::Vector3d middle_m = 0.5 * (rotors[0].p_BP_B_m + rotors[2].p_BP_B_m);
  EXPECT_TRUE(near(std::abs(middle_m.x()), 5e-3, round_off(8, 0.25)));
  EXPECT_TRUE(near((rotors[0].p_BP_B_m - rotors[2].p_BP_B_m).x(), 0.5, round_off(8, 0.5)));
  BoardDescription board = board_with_imu();
  set_parts(board, params);
  const auto place = std::get<std::vector<double>>(*board.devices[0].value("params.place"));
  EXPECT_TRUE(near(place.at(0), 0.01 + middle_m.x(), round_off(8, 0.25)));
}

TEST(VehicleParts, ImuDrawsFromItsDataSheet) {
  FlightParams params = quad(plant::ToleranceClass::worst);
  draw_parts(params, 2);
  BoardDescription board = board_with_imu();
  set_parts(board, params);
  const BoardDevice& imu = board.devices[0];
  const auto number = [&imu](const char* key) { return std::get<double>(*imu.value(key)); };
  EXPECT_TRUE(near(number("params.gyroscope.turn_on_bias"), 2.0 / 3.0 * 20.0 * M_PI / 180.0,
                   round_off(8, 1.0)));
  EXPECT_TRUE(near(number("params.gyroscope.cross_axis"), 0.04 / 3.0, round_off(8, 1.0)));
  EXPECT_TRUE(near(number("params.accelerometer.scale_error"), 0.02, round_off(8, 1.0)));
}

TEST(VehicleParts, WhatTheBoardsFileStatesOfItsImuStays) {
  FlightParams params = quad(plant::ToleranceClass::typical);
  draw_parts(params, 2);
  BoardDescription board = board_with_imu();
  board.devices[0].keys["params.gyroscope.turn_on_bias"] = 0.0;
  set_parts(board, params);
  const BoardDevice& imu = board.devices[0];
  EXPECT_EQ(std::get<double>(*imu.value("params.gyroscope.turn_on_bias")), 0.0);
  EXPECT_TRUE(imu.value("params.accelerometer.turn_on_bias"));
}

TEST(VehicleParts, AnImuOnCanIsACopyLikeOneOnSpi) {
  FlightParams params = quad(plant::ToleranceClass::typical);
  draw_parts(params, 2);
  BoardDescription spi = board_with_imu(), can = board_with_imu();
  can.devices[0].type = "mpu6000_dronecan";
  set_parts(spi, params);
  set_parts(can, params);
  EXPECT_FALSE(params.imu.empty());
  EXPECT_EQ(can.devices[0].keys, spi.devices[0].keys);
}

}  // namespace
}  // namespace whirl::flight

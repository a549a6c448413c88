// Each ESC of a vehicle's copy told what its own motor and propeller take in still air.
#include "harness/flight/still_air.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/flight/tests/paths.hpp"
#include "plant/air/atmosphere.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::flight {
namespace {

FlightParams by_power() {
  auto params =
      catalogue::read_vehicle(std::string(kSourceFolder) + "/test_plans/vehicles/hp_quad_st.lua");
  EXPECT_TRUE(params.ok()) << params.error().message();
  params.value().still_air->warm_up_ns = 3'000'000'000;  // of the drawing: nothing warms up
  return params.value();
}

double found(const FlightParams& params, std::size_t motor) {
  const float q2 = params.calibrations.at(motor).free_air.q2;
  return static_cast<double>(q2 / params.esc.calibration.free_air.q2);
}

double torque_Nm(const FlightParams& params, double density_kgpm3, double viscosity_Pas) {
  plant::RotorConditions c;
  c.omega_radps = 420.0;
  c.density_kgpm3 = density_kgpm3;
  c.viscosity_Pas = viscosity_Pas;
  return plant::Rotor(params.blade, 1).steady(c).shaft_torque_Nm;
}

// What is off of a propeller's torque, the ESC finds as a share of power, and so density. That constants of the switched
// stand read a percent less of an averaged motor is in all of them.
TEST(StillAirOfAVehicle, FindsWhatEachPropellerTakes) {
  FlightParams drawing = by_power(), copy = drawing, thin = drawing;
  for (FlightParams* params : {&drawing, &copy, &thin}) params->tolerance.clear();
  const double off[] = {-0.04, -0.02, 0.0, 0.03};
  for (std::size_t i = 0; i < 4; ++i) copy.vehicle.airframe.rotors[i].torque_error = off[i];
  thin.vehicle.air.ground_height_m = 300.0;
  for (FlightParams* params : {&drawing, &copy, &thin}) {
    const auto told = tell_still_air(*params, 1);
    ASSERT_TRUE(told.ok()) << told.error().message();
    ASSERT_EQ(params->calibrations.size(), 4u);
    ASSERT_EQ(params->drawn.size(), 4u);
  }
  const plant::Atmosphere low = plant::standard_atmosphere(0.0),
                          high = plant::standard_atmosphere(300.0);
  const double thinner = torque_Nm(thin, high.density_kgpm3, high.viscosity_Pas) /
                         torque_Nm(thin, low.density_kgpm3, low.viscosity_Pas);
  EXPECT_TRUE(near(thinner, 0.9715, stated(0.01, "density; a soft blade and drag beside it")));
  const Tolerance friction = stated(0.004, "friction and losses do not go with it");
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(near(found(copy, i) / found(drawing, i), 1.0 + off[i], friction)) << i;
    EXPECT_TRUE(near(found(thin, i) / found(drawing, i), thinner, friction)) << i;
    EXPECT_TRUE(near(copy.drawn[i].value, found(copy, i) - 1.0, stated(1e-6, "as told")));
  }
  EXPECT_EQ(copy.drawn[3].name, "motor 4 still_air");
  EXPECT_EQ(copy.esc_of(4).calibration.free_air.q2, copy.calibrations[3].free_air.q2);
}

// A motor that warms up: the flight begins where the warm-up ended, and what was told is of a warm one.
TEST(StillAirOfAVehicle, TheFlightBeginsAsWarmAsTheWarmUpEnded) {
  double share[2] = {}, start_K[2] = {};
  for (const int longer : {0, 1}) {
    FlightParams params = by_power();
    params.vehicle.motor.heat_capacity_JpK = 20.0;
    params.vehicle.motor.bearing_share = 0.3;
    params.vehicle.motors.assign(4, params.vehicle.motor);
    params.still_air->warm_up_ns = longer ? 20'000'000'000 : 3'000'000'000;
    const auto told = tell_still_air(params, 1);
    ASSERT_TRUE(told.ok()) << told.error().message();
    EXPECT_EQ(params.calibrations[1].mode, fw::esc::Mode::thrust_by_power);
    share[longer] = found(params, 1);
    start_K[longer] = params.vehicle.motors[1].start_temp_K;
  }
  EXPECT_GT(start_K[0], plant::MotorParams{}.ambient_temp_K + 0.5);
  EXPECT_GT(start_K[1], start_K[0] + 3.0);
  EXPECT_LT(share[1], share[0] - 0.005);  // its grease is thinner
}

// Whether an ESC would take what it does not know yet for a wind does not matter to the rig, which is run by speed.
TEST(StillAirOfAVehicle, AnEscThatWouldTellAWindRunsNoFaster) {
  double start_K[2] = {};
  for (const int tells : {0, 1}) {
    FlightParams params = by_power();
    params.esc.calibration.shared_power = tells ? 0.97f : 0.5f;
    params.vehicle.motor.heat_capacity_JpK = 20.0;
    params.vehicle.motors.assign(4, params.vehicle.motor);
    params.vehicle.airframe.rotors[0].torque_error = -0.1;
    ASSERT_TRUE(tell_still_air(params, 1).ok());
    start_K[tells] = params.vehicle.motors[0].start_temp_K;
  }
  EXPECT_EQ(start_K[0], start_K[1]);
}

TEST(StillAirOfAVehicle, WithoutBeingAskedAllFlyWithTheFile) {
  FlightParams params = by_power();
  params.still_air.reset();
  ASSERT_TRUE(tell_still_air(params, 1).ok());
  EXPECT_TRUE(params.calibrations.empty());
  EXPECT_EQ(params.esc_of(2).calibration.free_air.q2, params.esc.calibration.free_air.q2);
}

TEST(StillAirOfAVehicle, SaysWhichEscRefuses) {
  FlightParams params = by_power();
  params.vehicle.airframe.rotors[2].torque_error = 0.4;
  const auto told = tell_still_air(params, 1);
  ASSERT_FALSE(told.ok());
  EXPECT_EQ(told.error().place, "esc.still_air");
  EXPECT_NE(told.error().what.find("motor 3"), std::string::npos) << told.error().what;
  params.far_shafts.resize(4);
  EXPECT_NE(tell_still_air(params, 1).error().what.find("boards"), std::string::npos);
}

}  // namespace
}  // namespace whirl::flight

#include "harness/stand/stage_params.hpp"

#include <gtest/gtest.h>

namespace whirl::stand {
namespace {

// What a stage's names say of motor and current sense is the same there and back.
TEST(StageParams, AreAMotorAndACurrentSenseThereAndBack) {
  plant::MotorParams motor;
  motor.torque_constant_NmpA = 0.02, motor.resistance_ohm = 0.3, motor.inductance_H = 5e-5;
  motor.no_load_current_A = 0.4, motor.inertia_kgm2 = 1e-5;
  motor.heat_capacity_JpK = 20.0, motor.bearing_share = 0.2;
  plant::CurrentShuntParams shunt;
  shunt.gain_tolerance = 0.03, shunt.warm_up_A = 0.1, shunt.wander_A = 0.02;
  const StageParams stage = stage_of(motor, shunt);
  EXPECT_EQ(stage.size(), 10u);
  EXPECT_EQ(stage_of(motor_of(stage), shunt_of(stage)), stage);
}

TEST(StageParams, AWindingHasNoMoreResistanceThanTheWhole) {
  const plant::MotorParams motor = motor_of({{"resistance", 0.050}});
  EXPECT_EQ(motor.resistance_ohm, 0.050);
  EXPECT_TRUE(plant::validate(motor, "motor").ok());
}

}  // namespace
}  // namespace whirl::stand

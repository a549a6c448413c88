// The two faces of one motor in steady state: each was written without the other, each is the other's
// oracle. Propeller loads from idle to beyond the motor's rating.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "plant/validation/motor_faces.hpp"

namespace whirl::plant {
namespace {

struct Case {
  const char* name;
  FaceCase face;
};

void expect_agreement(const Case& c, std::initializer_list<double> duties, double share = 0.01) {
  for (bool diode : {false, true}) {
    for (double duty : duties) {
      const MotorFace a = averaged_face(c.face, duty, diode);
      const MotorFace s = switched_face(c.face, duty, diode, a.speed_radps);
      const auto within = stated(share, "of each other in steady state");
      const std::string where = std::string(c.name) + (diode ? ", diode " : ", synchronous ");
      EXPECT_TRUE(near(a.speed_radps / s.speed_radps, 1.0, within)) << where << duty << " speed";
      EXPECT_TRUE(near(a.shaft_Nm / s.shaft_Nm, 1.0, within)) << where << duty << " torque";
      EXPECT_TRUE(near(a.winding_A / s.winding_A, 1.0, within)) << where << duty << " winding";
      EXPECT_TRUE(near(a.bus_A / s.bus_A, 1.0, within)) << where << duty << " bus";
    }
  }
}

constexpr double kLoad = 1.9e-7;  // a 10 x 4.5

TEST(MotorFaces, AgreeOverAllDuties) {
  expect_agreement({"D2836/9", {{}, 16.4, kLoad}}, {0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9});
}

TEST(MotorFaces, AgreeWithSinusoidalBackEmf) {
  MotorParams motor;
  motor.back_emf = BackEmf::sinusoidal;
  expect_agreement({"sine", {motor, 16.4, kLoad}}, {0.1, 0.2, 0.3, 0.6, 0.9});
  expect_agreement({"sine", {motor, 16.4, kLoad}}, {0.4, 0.5}, 0.021);  // where dips run dry
}

TEST(MotorFaces, AgreeForALargeSlowMotorOfManyPoles) {
  MotorParams motor;
  motor.torque_constant_NmpA = 60.0 / (2.0 * M_PI * 400.0);
  motor.resistance_ohm = 0.15;
  motor.inductance_H = 8e-5;
  motor.pole_pairs = 12;
  motor.no_load_current_A = 0.6;
  motor.inertia_kgm2 = 3e-4;
  expect_agreement({"400 Kv on 6S", {motor, 24.0, 3e-6}}, {0.15, 0.3, 0.5, 0.8});
}

TEST(MotorFaces, AgreeWithMoreInductanceWithMoreResistanceAndWithFewerPoles) {
  MotorParams inductive, resistive, slow;
  inductive.inductance_H = 1e-4;
  resistive.inductance_H = 5e-5;
  resistive.resistance_ohm = 0.3;
  slow.pole_pairs = 2;
  for (const Case& c :
       {Case{"0.1 mH", {inductive, 16.4, kLoad}}, Case{"0.3 ohm", {resistive, 16.4, kLoad}},
        Case{"2 pole pairs", {slow, 16.4, kLoad}}}) {
    expect_agreement(c, {0.15, 0.4, 0.8});
  }
}

// Without inductance to speak of both are the plain DC motor.
TEST(MotorFaces, WithoutInductanceBothAreTheDcMotor) {
  MotorParams motor;
  motor.inductance_H = 1e-6;
  expect_agreement({"1 uH", {motor, 16.4, kLoad}}, {1.0});
}

// What an apparent resistance is: by its DC resistance alone the motor would run faster.
TEST(MotorFaces, CommutationSlowsTheMotor) {
  const FaceCase with{{}, 16.4, kLoad};
  FaceCase without = with;
  without.motor.pole_pairs = 1;
  EXPECT_LT(switched_face(with, 0.5, false, 600.0).speed_radps,
            0.98 * switched_face(without, 0.5, false, 600.0).speed_radps);
}

}  // namespace
}  // namespace whirl::plant

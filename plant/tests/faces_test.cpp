// The two faces of one motor in steady state: each was written without the other, each is the other's
// oracle. Propeller loads from idle to beyond the motor's rating.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/base/near.hpp"
#include "plant/motor/averaged_motor.hpp"
#include "plant/motor/switched_motor.hpp"

namespace whirl::plant {
namespace {

struct Face {
  double speed_radps, torque_Nm, winding_A, bus_A;
};

struct Case {
  const char* name;
  MotorParams motor;
  double bus_V, quadratic_Nm_s2;
};

Face face(const MotorBooks& books, double time_s, double speed_radps) {
  const double shaft_J = books.air_J + books.no_load_J + books.kinetic_J;
  return {speed_radps, shaft_J / time_s / speed_radps, books.winding_charge_C / time_s,
          books.bus_charge_C / time_s};
}

Face averaged(const Case& c, double duty, bool diode) {
  AveragedMotor motor(c.motor);
  motor.set_speed(0.8 * duty * c.bus_V / c.motor.torque_constant_NmpA);
  MotorBooks sum;
  constexpr int kSettle = 14000, kMeasure = 2000;
  for (int k = 0; k < kSettle + kMeasure; ++k) {
    if (k == kSettle) sum = {};
    sum += motor.step({c.bus_V, duty, diode}, {c.quadratic_Nm_s2, 0.0}, 1.25e-4);
  }
  return face(sum, kMeasure * 1.25e-4, motor.speed_radps());
}

// Bridge commutated at the right angle, in 25 slices per PWM period.
MotorBooks run_period(SwitchedMotor& motor, double period_s, double duty, bool diode) {
  MotorBooks sum;
  const double on_s = duty * period_s;
  for (double t = 0.0; t < period_s - 1e-12;) {
    const bool on = t < on_s - 1e-12;
    const double h = std::min(period_s / 25.0, (on ? on_s : period_s) - t);
    motor.set_bridge(six_step(sector_of(motor.electrical_angle_rad()), on, !diode));
    sum += motor.run(h);
    t += h;
  }
  return sum;
}

Face switched(const Case& c, double duty, bool diode, double start_radps) {
  const double period_s = 1.0 / c.motor.pwm_Hz;
  constexpr int kSettle = 6000, kMeasure = 3000;
  SwitchedMotor motor(c.motor);
  motor.set_bus(c.bus_V);
  motor.set_load({c.quadratic_Nm_s2, 0.0});
  motor.set_speed(start_radps);
  for (int k = 0; k < kSettle; ++k) run_period(motor, period_s, duty, diode);
  MotorBooks sum;
  double speed = 0.0;
  for (int k = 0; k < kMeasure; ++k) {
    sum += run_period(motor, period_s, duty, diode);
    speed += motor.speed_radps() / kMeasure;
  }
  return face(sum, kMeasure * period_s, speed);
}

void expect_agreement(const Case& c, std::initializer_list<double> duties, double share = 0.01) {
  for (bool diode : {false, true}) {
    for (double duty : duties) {
      const Face a = averaged(c, duty, diode);
      const Face s = switched(c, duty, diode, a.speed_radps);
      const auto within = stated(share, "of each other in steady state");
      const std::string where = std::string(c.name) + (diode ? ", diode " : ", synchronous ");
      EXPECT_TRUE(near(a.speed_radps / s.speed_radps, 1.0, within)) << where << duty << " speed";
      EXPECT_TRUE(near(a.torque_Nm / s.torque_Nm, 1.0, within)) << where << duty << " torque";
      EXPECT_TRUE(near(a.winding_A / s.winding_A, 1.0, within)) << where << duty << " winding";
      EXPECT_TRUE(near(a.bus_A / s.bus_A, 1.0, within)) << where << duty << " bus";
    }
  }
}

constexpr double kLoad = 1.9e-7;  // a 10 x 4.5

TEST(MotorFaces, AgreeOverAllDuties) {
  expect_agreement({"D2836/9", {}, 16.4, kLoad}, {0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9});
}

TEST(MotorFaces, AgreeWithSinusoidalBackEmf) {
  MotorParams motor;
  motor.back_emf = BackEmf::sinusoidal;
  expect_agreement({"sine", motor, 16.4, kLoad}, {0.1, 0.2, 0.3, 0.6, 0.9});
  expect_agreement({"sine", motor, 16.4, kLoad}, {0.4, 0.5}, 0.021);  // where dips run dry
}

TEST(MotorFaces, AgreeForALargeSlowMotorOfManyPoles) {
  MotorParams motor;
  motor.torque_constant_NmpA = 60.0 / (2.0 * M_PI * 400.0);
  motor.resistance_ohm = 0.15;
  motor.inductance_H = 8e-5;
  motor.pole_pairs = 12;
  motor.no_load_current_A = 0.6;
  motor.inertia_kgm2 = 3e-4;
  expect_agreement({"400 Kv on 6S", motor, 24.0, 3e-6}, {0.15, 0.3, 0.5, 0.8});
}

TEST(MotorFaces, AgreeWithMoreInductanceWithMoreResistanceAndWithFewerPoles) {
  MotorParams inductive, resistive, slow;
  inductive.inductance_H = 1e-4;
  resistive.inductance_H = 5e-5;
  resistive.resistance_ohm = 0.3;
  slow.pole_pairs = 2;
  for (const Case& c :
       {Case{"0.1 mH", inductive, 16.4, kLoad}, Case{"0.3 ohm", resistive, 16.4, kLoad},
        Case{"2 pole pairs", slow, 16.4, kLoad}}) {
    expect_agreement(c, {0.15, 0.4, 0.8});
  }
}

// Without inductance to speak of both are the plain DC motor.
TEST(MotorFaces, WithoutInductanceBothAreTheDcMotor) {
  MotorParams motor;
  motor.inductance_H = 1e-6;
  expect_agreement({"1 uH", motor, 16.4, kLoad}, {1.0});
}

// What an apparent resistance is: by its DC resistance alone the motor would run faster.
TEST(MotorFaces, CommutationSlowsTheMotor) {
  const Case with{"", {}, 16.4, kLoad};
  Case without = with;
  without.motor.pole_pairs = 1;
  EXPECT_LT(switched(with, 0.5, false, 600.0).speed_radps,
            0.98 * switched(without, 0.5, false, 600.0).speed_radps);
}

}  // namespace
}  // namespace whirl::plant

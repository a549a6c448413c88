#include "plant/motor/averaged_motor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "base/random.hpp"

namespace whirl::plant {
namespace {

MotorParams turnigy() {
  return MotorParams{};
}

MotorParams uncommutated() {  // phases change, and PWM pulses, unnoticed by a fast winding
  MotorParams params;
  params.pole_pairs = 1;
  params.inductance_H = 2e-6;
  params.pwm_Hz = 1e6;
  params.diode_drop_V = 3.0;
  return params;
}

double imbalance_J(const MotorBooks& b) {
  return b.electrical_in_J - b.copper_J - b.diode_J - b.no_load_J - b.magnetic_J - b.kinetic_J -
         b.air_J;
}
double scale_J(const MotorBooks& b) {
  return std::abs(b.electrical_in_J) + b.copper_J + std::abs(b.magnetic_J) + std::abs(b.kinetic_J) +
         std::abs(b.air_J) + b.no_load_J;
}

// A held shaft is an R-L circuit: i = V/R (1 - exp(-t R/L)).
TEST(AveragedMotor, HeldShaftFollowsTheExponentialOfResistanceAndInductance) {
  AveragedMotor motor(turnigy());
  motor.block();
  double t = 0.0;
  for (int k = 0; k < 20; ++k) {
    motor.step({.bus_V = 2.0, .duty = 0.5}, {}, 1e-4);
    t += 1e-4;
    const double want = 1.0 / 0.12 * (1.0 - std::exp(-t * 0.12 / 2.0e-5));
    EXPECT_TRUE(near(motor.current_A(), want, round_off(40, 8.4)));
  }
}

TEST(AveragedMotor, StallCurrentIsVoltageOverResistance) {
  AveragedMotor motor(turnigy());
  motor.block();
  for (int k = 0; k < 200; ++k) motor.step({.bus_V = 16.0, .duty = 0.1}, {}, 1e-4);
  EXPECT_TRUE(near(motor.current_A(), 1.6 / 0.12, stated(1e-9, "109 time constants")));
}

// Free running: the current is the no-load current, the speed what is left of the voltage by Kv.
TEST(AveragedMotor, FreeRunningSpeedIsVoltageLessNoLoadDropTimesKv) {
  AveragedMotor motor(uncommutated());
  for (int k = 0; k < 40000; ++k) motor.step({.bus_V = 12.0, .duty = 0.5}, {}, 1e-4);
  EXPECT_TRUE(near(motor.current_A(), 1.0, stated(1e-4, "the outgoing phase pushes a little")));
  EXPECT_TRUE(near(motor.speed_radps() * 30.0 / M_PI, (6.0 - 0.12) * 950.2,
                   stated(1.0, "Kv is printed to 950, Kt to four digits")));
}

TEST(AveragedMotor, CoastingShaftSlowsByNoLoadTorqueAloneAndStops) {
  AveragedMotor motor(turnigy());
  motor.set_speed(400.0);
  const double decel = 0.01005 * 1.0 / 3.752e-5;
  for (int k = 0; k < 1000; ++k) motor.step({.bus_V = 16.0, .diode = true}, {}, 1e-3);
  EXPECT_TRUE(near(motor.speed_radps(), 400.0 - decel, stated(1e-9, "linear in time")));
  for (int k = 0; k < 1000; ++k) motor.step({.bus_V = 16.0, .diode = true}, {}, 1e-3);
  EXPECT_EQ(motor.speed_radps(), 0.0);
}

TEST(AveragedMotor, ShortedWindingBrakesAndDiodesDoNot) {
  AveragedMotor shorted(uncommutated()), coasting(uncommutated());
  for (AveragedMotor* motor : {&shorted, &coasting}) motor->set_speed(400.0);
  for (int k = 0; k < 100; ++k) {
    shorted.step({.bus_V = 16.0, .duty = 0.0}, {}, 1e-4);
    coasting.step({.bus_V = 16.0, .duty = 0.0, .diode = true}, {}, 1e-4);
    EXPECT_LE(shorted.current_A(), 0.0);
    EXPECT_EQ(coasting.current_A(), 0.0);
  }
  // Shorted: (w + i0 R / Kt) decays with J R / Kt^2 = 45 ms.
  const double settle = 0.12 / 0.01005, decay = std::exp(-0.010 / 0.04458);
  EXPECT_TRUE(near(shorted.speed_radps(), (400.0 + settle) * decay - settle, stated(1.0, "L/R")));
  EXPECT_TRUE(near(coasting.speed_radps(), 400.0 - 2.679, stated(0.01, "no-load torque")));
}

// What commutation does is held over a sub-step: first order, but little.
TEST(AveragedMotor, SpinUpHardlyDependsOnTheSubStep) {
  auto speed_after_10ms = [](int steps) {
    AveragedMotor motor(turnigy());
    motor.set_speed(200.0);
    for (int k = 0; k < steps; ++k) {
      motor.step({.bus_V = 16.0, .duty = 0.35}, {.quadratic_Nm_s2 = 2e-7}, 0.01 / steps);
    }
    return motor.speed_radps();
  };
  const double exact = speed_after_10ms(10000);
  EXPECT_TRUE(near(speed_after_10ms(80), exact, stated(0.02, "of 155 rad/s gained")));
  EXPECT_TRUE(near(speed_after_10ms(160), exact, stated(0.01, "half of it")));
}

TEST(AveragedMotor, EnergyBooksCloseAtEveryStepUnderAbsurdCommands) {
  for (bool diode : {false, true}) {
    AveragedMotor motor(turnigy());
    RandomStream random(1, "motor");
    Drive drive{.bus_V = 15.0, .duty = 0.0, .diode = diode};
    ShaftLoad load;
    for (int k = 0; k < 100000; ++k) {
      if (k % 17 == 0) drive.duty = random.uniform();
      if (k % 23 == 0) drive.bus_V = 1.0 + 20.0 * random.uniform();
      if (k % 31 == 0) load = {3e-7 * random.uniform(), 0.02 * (random.uniform() - 0.7)};
      const MotorBooks books = motor.step(drive, load, 1.25e-4);
      const double w = motor.speed_radps() + 10.0, i = motor.current_A() + 10.0;
      const double stored_J = 0.5 * (3.752e-5 * w * w + 2.0e-5 * i * i);
      ASSERT_TRUE(near(imbalance_J(books), 0.0, round_off(20, scale_J(books) + stored_J)))
          << k << " " << diode;
      ASSERT_GE(books.copper_J, 0.0);
      ASSERT_GE(books.diode_J, -1e-15);
      ASSERT_GE(books.no_load_J, -1e-12);
      ASSERT_GE(motor.speed_radps(), 0.0);
      ASSERT_TRUE(!diode || motor.current_A() >= 0.0);
    }
  }
}

TEST(AveragedMotor, DiodeCurrentInLightLoadIsThePulseTrainsMean) {
  // Closed form without resistance: (V - E) V' D^2 T / (2 L (E + Vd)), V' = V + Vd.
  MotorParams params = turnigy();
  params.resistance_ohm = 1e-3;
  params.winding_resistance_ohm = 0.0;
  params.no_load_current_A = 0.0;
  params.inertia_kgm2 = 1.0;  // holds its speed
  params.pole_pairs = 1;
  AveragedMotor motor(params);
  motor.set_speed(60.0);  // so slow that the open phase's diode never conducts
  const double emf = 0.603, V = 16.0, D = 0.02, T = 5e-5, L = 2.0e-5;
  for (int k = 0; k < 50; ++k) motor.step({.bus_V = V, .duty = D, .diode = true}, {}, 1e-4);
  const double want = (V - emf) * (V + 0.7) * D * D * T / (2.0 * L * (emf + 0.7));
  EXPECT_TRUE(near(motor.current_A(), want, stated(1e-3 * want, "1 mohm is left")));
}

// Ripple of 0.75 A about a mean of 3 A never runs dry: the mean voltage rules, diode drop included.
TEST(AveragedMotor, DiodeCurrentThatNeverRunsDryFollowsTheMeanVoltage) {
  MotorParams params = turnigy();
  params.inertia_kgm2 = 1.0;  // holds its speed
  params.inductance_H = 1e-4;
  params.pole_pairs = 1;
  AveragedMotor motor(params);
  motor.set_speed(60.0);
  for (int k = 0; k < 100; ++k) motor.step({.bus_V = 16.0, .duty = 0.1, .diode = true}, {}, 1e-4);
  const double want = (0.1 * 16.0 - 0.9 * 0.7 - 0.01005 * 60.0) / motor.running_ohm();
  EXPECT_TRUE(
      near(motor.current_A(), want, stated(0.01, "waiting for a pulse after commutations")));
}

TEST(AveragedMotor, WarmWindingHasMoreResistance) {
  MotorParams params = turnigy();
  params.heat_capacity_JpK = 0.03;  // a thousand times faster than it happens
  AveragedMotor motor(params);
  motor.block();
  for (int k = 0; k < 2000; ++k) {
    MotorBooks sum;
    sum += motor.step({.bus_V = 16.0, .duty = 0.1}, {}, 1e-3);
    motor.warm(sum, 1e-3);
  }
  // Settles where R_w i^2 x (K/W) is the rise: solved by bisection outside this code.
  const double rise = motor.winding_temperature_K() - 293.15;
  const double R = 0.12 + 0.07 * 0.00393 * rise, i = 1.6 / R;
  EXPECT_TRUE(near(motor.resistance_ohm(), R, round_off(8, R)));
  EXPECT_TRUE(near(rise, 3.0 * i * i * (R - 0.05), stated(0.5, "settled")));
}

TEST(MotorParams, RefusesWhatNoMotorIs) {
  for (double bad : {-1.0, 0.0, std::nan("")}) {
    MotorParams params = turnigy();
    params.inductance_H = bad;
    const auto result = validate(params, "motor.lua:3");
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().message().find("motor.lua:3: inductance_H"), std::string::npos);
  }
}

}  // namespace
}  // namespace whirl::plant

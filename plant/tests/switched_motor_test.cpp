#include "plant/motor/switched_motor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "base/random.hpp"

namespace whirl::plant {
namespace {

constexpr double kDeg = M_PI / 180.0;

double imbalance_J(const MotorBooks& b) {
  return b.electrical_in_J - b.copper_J - b.diode_J - b.no_load_J - b.magnetic_J - b.kinetic_J -
         b.air_J;
}

// Two windings conducting with the shaft held are one R-L circuit of the line-to-line values.
TEST(SwitchedMotor, HeldShaftIsTheLineToLineCircuit) {
  SwitchedMotor motor{MotorParams{}};
  motor.block();
  motor.set_angle(60 * kDeg);
  motor.set_bus(1.6);
  motor.set_bridge(six_step(0, true, true));
  motor.run(4e-4);
  const double want = 1.6 / 0.12 * (1.0 - std::exp(-4e-4 * 0.12 / 2.0e-5));
  EXPECT_TRUE(near(motor.phase_currents_A()[0], want, round_off(200, 16.0)));
  EXPECT_TRUE(near(motor.phase_currents_A()[1], -want, round_off(200, 16.0)));
  EXPECT_EQ(motor.phase_currents_A()[2], 0.0);
  EXPECT_TRUE(near(motor.bus_current_A(), want, round_off(200, 16.0)));
}

// The open phase sits at half the bus plus its back-EMF: what a zero-crossing detector looks for.
TEST(SwitchedMotor, FloatingPhaseCrossesHalfTheBusWhenItsBackEmfCrossesZero) {
  SwitchedMotor motor{MotorParams{}};
  motor.set_bus(10.0);
  motor.set_speed(400.0);
  motor.set_bridge(six_step(0, true, true));  // a high, b low, c open: c crosses zero at 60 degrees
  for (double degrees : {50.0, 60.0, 70.0}) {
    motor.set_angle(degrees * kDeg);
    const double emf = 0.01005 / 2.0 * 400.0 * (60.0 - degrees) / 30.0;
    const auto v = motor.phase_voltages();
    EXPECT_EQ(v[0], 10.0);
    EXPECT_EQ(v[1], 0.0);
    EXPECT_TRUE(near(v[2], 5.0 + emf, round_off(64, 5.0))) << degrees;
  }
}

TEST(SwitchedMotor, SwitchedOffPhaseFreewheelsThroughADiodeUntilItsCurrentIsGone) {
  SwitchedMotor motor{MotorParams{}};
  motor.block();
  motor.set_bus(16.0);
  motor.set_bridge({.leg = {Leg::high, Leg::low, Leg::off}});
  motor.run(1e-4);
  const double peak = motor.phase_currents_A()[0];
  motor.set_bridge({});  // everything off: current flows back into the bus against V + 2 Vd
  EXPECT_TRUE(near(motor.phase_voltages()[0], -0.7, round_off(4, 1.0)));
  EXPECT_TRUE(near(motor.phase_voltages()[1], 16.7, round_off(4, 16.0)));
  EXPECT_LT(motor.bus_current_A(), 0.0);
  const double tau = 2.0e-5 / 0.12, dead = tau * std::log1p(peak * 0.12 / 17.4);
  motor.run(0.98 * dead);
  EXPECT_GT(motor.phase_currents_A()[0], 0.0);
  motor.run(0.03 * dead);
  EXPECT_EQ(motor.phase_currents_A()[0], 0.0);
  EXPECT_EQ(motor.bus_current_A(), 0.0);
}

TEST(SwitchedMotor, CoastsWithoutCurrentAndBrakesWhenShorted) {
  SwitchedMotor coasting{MotorParams{}}, shorted{MotorParams{}};
  for (SwitchedMotor* motor : {&coasting, &shorted}) {
    motor->set_bus(16.0);
    motor->set_speed(400.0);
  }
  shorted.set_bridge({.leg = {Leg::low, Leg::low, Leg::low}});
  coasting.run(0.01);
  shorted.run(0.01);
  EXPECT_EQ(coasting.peak_current_A(), 0.0);
  EXPECT_TRUE(near(coasting.speed_radps(), 400.0 - 2.679, stated(0.01, "no-load torque")));
  EXPECT_LT(shorted.speed_radps(), 380.0);
}

// Driven faster than the bus can push, the diodes rectify: current into the pack.
TEST(SwitchedMotor, OverspeedFeedsTheBusThroughTheDiodes) {
  SwitchedMotor motor{MotorParams{}};
  motor.set_bus(3.0);
  motor.set_speed(600.0);  // 6.03 V line to line against 3 + 2 x 0.7
  const MotorBooks books = motor.run(1e-3);
  EXPECT_LT(books.bus_charge_C, 0.0);
  EXPECT_LT(motor.bus_current_A(), 0.0);
}

TEST(SwitchedMotor, LateCommutationCostsTorque) {
  auto torque = [](double late_deg) {
    MotorParams heavy;
    heavy.inertia_kgm2 = 1.0;
    SwitchedMotor motor{heavy};
    motor.set_bus(5.5);
    motor.set_speed(400.0);
    MotorBooks sum;
    for (int k = 0; k < 10000; ++k) {
      const double seen = motor.electrical_angle_rad() - late_deg * kDeg;
      motor.set_bridge(six_step(sector_of(seen), true, true));
      sum += motor.run(2e-6);
    }
    return (sum.kinetic_J + sum.no_load_J) / (400.0 * 0.02) / (sum.copper_J / 0.02);
  };
  EXPECT_GT(torque(0.0), 1.1 * torque(20.0));  // per watt of heat
  EXPECT_GT(torque(20.0), 1.1 * torque(40.0));
}

// A motor out of the bag: phases that differ, cogging, a shape between trapezoid and sine.
MotorParams uneven() {
  MotorParams params;
  params.phases = {.impedance = {0.03, -0.02, 0.01},
                   .emf = {-0.01, 0.005, 0.01},
                   .sine_share = 0.4,
                   .cogging_Nm = 5e-3};
  return params;
}

// Phases a and b in series are the line-to-line circuit times the mean of what they are off by.
TEST(SwitchedMotor, UnevenPhasesCarryTheCurrentOfTheirOwnImpedance) {
  SwitchedMotor motor{uneven()};
  motor.block();
  motor.set_bus(1.6);
  motor.set_bridge({.leg = {Leg::high, Leg::low, Leg::off}});
  motor.run(4e-4);
  const double want = 1.6 / (0.12 * 1.005) * (1.0 - std::exp(-4e-4 * 0.12 / 2.0e-5));
  EXPECT_TRUE(near(motor.phase_currents_A()[0], want, round_off(200, 16.0)));
  // The open phase shows the star point: less than half where the upper phase is the larger one.
  EXPECT_TRUE(near(motor.phase_voltages()[2], 1.6 * 0.98 / 2.01, round_off(16, 1.6)));
}

TEST(SwitchedMotor, PhaseWithMoreBackEmfShowsItWhereItFloats) {
  MotorParams params;
  params.phases.emf = {0.0, 0.0, 0.01};
  SwitchedMotor motor{params};
  motor.set_bus(10.0);
  motor.set_speed(400.0);
  motor.set_angle(50.0 * kDeg);
  motor.set_bridge(six_step(0, true, true));
  const double emf = 1.01 * 0.01005 / 2.0 * 400.0 / 3.0;
  EXPECT_TRUE(near(motor.phase_voltages()[2], 5.0 + emf, round_off(64, 5.0)));
}

// A rotor let go with no friction swings about a detent as a pendulum does.
TEST(SwitchedMotor, CoggingPullsToTheNextDetent) {
  MotorParams params;
  params.no_load_current_A = 0.0;
  params.phases.cogging_Nm = 5e-3;
  SwitchedMotor motor{params};
  constexpr double kPeriods = 12 * 7;  // in a turn of the shaft
  motor.set_angle(1.0 * kDeg);         // 12 degrees of a period: a small swing
  motor.run(1e-3);
  const double w = std::sqrt(5e-3 * kPeriods / params.inertia_kgm2);  // of the swing, rad/s
  const double want = -1.0 * kDeg / 7.0 * w * std::sin(w * 1e-3);
  EXPECT_TRUE(near(motor.speed_radps(), want, stated(0.02 * std::abs(want), "12 degrees, not 0")));
}

TEST(SwitchedMotor, WarmMotorHasMoreResistanceLessFluxAndThinnerGrease) {
  MotorParams cold;
  cold.bearing_share = 0.3;
  const MotorParams hot = at_temperature(cold, 293.15 + 50.0);
  EXPECT_TRUE(near(hot.resistance_ohm, 0.12 + 0.07 * 0.1965, round_off(8, 0.12)));
  EXPECT_TRUE(near(hot.torque_constant_NmpA, 0.95 * 0.01005, round_off(8, 0.01)));
  const double friction = 0.01005 * (0.7 + 0.3 * std::exp(-2.0));  // as a torque
  EXPECT_TRUE(
      near(hot.no_load_current_A * hot.torque_constant_NmpA, friction, round_off(16, 0.01)));
}

TEST(SwitchedMotor, HeldShaftSettlesWhereHeatLeavesAsFastAsItComes) {
  MotorParams params;
  params.heat_capacity_JpK = 0.02;
  SwitchedMotor motor{params};
  motor.block();
  motor.set_bus(1.2);
  motor.set_bridge({.leg = {Leg::high, Leg::low, Leg::off}});
  for (int ms = 0; ms < 1000; ++ms) motor.warm(motor.run(1e-3), 1e-3);
  const double rise = motor.winding_temperature_K() - 293.15, R = 0.12 + 0.07 * 0.00393 * rise;
  EXPECT_GT(rise, 15.0);
  EXPECT_TRUE(near(rise, 3.0 * 1.44 / R / R * (R - 0.05), stated(0.1, "settled")));
}

TEST(SwitchedMotor, EnergyBooksCloseForAnyPattern) {
  for (int copy : {0, 1, 2}) {
    MotorParams params = copy == 2 ? uneven() : MotorParams{};
    params.back_emf = copy == 1 ? BackEmf::sinusoidal : BackEmf::trapezoidal;
    SwitchedMotor motor{params};
    motor.set_load({2e-7, 0.0});
    motor.set_speed(300.0);
    RandomStream random(9, "bridge");
    MotorBooks sum;
    double throughput = 0.0;
    for (int k = 0; k < 50000; ++k) {
      motor.set_bus(10.0 + 6.0 * random.uniform());
      Bridge bridge;
      for (Leg& leg : bridge.leg) leg = static_cast<Leg>(random.bits() % 4);
      bridge.pwm_on = random.bits() % 2 == 0;
      motor.set_bridge(bridge);
      const MotorBooks books = motor.run(40e-6 * random.uniform());
      sum += books;
      throughput += std::abs(books.electrical_in_J) + books.copper_J;
      const auto& i = motor.phase_currents_A();
      ASSERT_TRUE(near(i[0] + i[1] + i[2], 0.0, stated(1e-9, "star")));
      ASSERT_TRUE(std::isfinite(motor.speed_radps()));
    }
    EXPECT_TRUE(near(imbalance_J(sum) / throughput, 0.0, stated(1e-4, "speed held within a step")));
  }
}

}  // namespace
}  // namespace whirl::plant

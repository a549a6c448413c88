#include "harness/sweep/sweep.hpp"

#include <cmath>
#include <numbers>

#include "base/near.hpp"
#include "harness/catalogue/propeller_file.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/flight/controllers.hpp"
#include "plant/rotor/fitted_blade.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::sweep {
namespace {

flight::FlightParams quad() {
  const auto params =
      catalogue::read_vehicle(std::string(WHIRL_ROOT) + "/test_plans/vehicles/hp_quad.lua");
  EXPECT_TRUE(params.ok()) << (params.ok() ? "" : params.error().message());
  return params.value();
}

TEST(Sweep, ElectricalPowerIsShaftPowerAndTheNamedLosses) {
  for (double voltage_V : {3.0, 6.0, 12.0}) {
    const DrivePoint p = drive_point(quad(), voltage_V, 16.4);
    EXPECT_TRUE(near(p.electrical_W, p.shaft_W + p.copper_W + p.diode_W + p.no_load_W,
                     stated(1e-3 * p.electrical_W, "speed has settled to 1e-7 of itself a piece")));
  }
}

// A chopper draws duty x winding current, less what each commutation hands back to the bus.
TEST(Sweep, BusCurrentIsDutyTimesWindingCurrentLessWhatCommutationsGiveBack) {
  const DrivePoint p = drive_point(quad(), 8.2, 16.4);
  EXPECT_LT(p.bus_A, 0.5 * p.winding_A);
  EXPECT_GT(p.bus_A, 0.93 * 0.5 * p.winding_A);
}

// Back-EMF, resistance and, between the pulses, a diode: V = Ke w + R i + (1 - duty) Vd, with the
// datasheet's Kv and what the thesis's points show of R on a running motor.
TEST(Sweep, TheMotorsVoltageEquationHolds) {
  const DrivePoint p = drive_point(quad(), 6.0, 16.4);
  const double ke = 60.0 / (2.0 * std::numbers::pi * 950.0);
  const double diode_V = (1.0 - 6.0 / 16.4) * 0.7;
  const double apparent_ohm = (p.voltage_V - diode_V - ke * p.speed_radps) / p.winding_A;
  EXPECT_GT(apparent_ohm, 0.12);
  EXPECT_LT(apparent_ohm, 0.18);
}

// Four of its motor controllers with their motors on its bus, held at a place by a hand as strong as it
// takes, with the set-point at which the four carry its weight.
struct HeldInHover {
  flight::FlightParams params = quad();
  plant::Vehicle vehicle{params.vehicle,
                         plant::blade_element_rotors(params.blade, params.vehicle.airframe), 1};
  std::vector<std::unique_ptr<flight::MotorController>> escs;

  HeldInHover() {
    for (int motor = 1; motor <= 4; ++motor) {
      escs.push_back(
          flight::type_named(params.controller, flight::controller_types()).make(params, 1, motor));
    }
  }
  struct Means {
    double thrust_N = 0.0, battery_A = 0.0;
  };
  Means run(int ms, int setpoint) {
    Means sum;
    for (int k = 0; k < ms; ++k) {
      for (int i = 0; i < 4; ++i) {
        auto& esc = *escs[static_cast<std::size_t>(i)];
        if (k % 20 == 0) esc.write(static_cast<std::uint16_t>(setpoint));
        const plant::VehicleState& s = vehicle.state();
        vehicle.command(
            i, esc.step(k_ * 1'000'000LL, s.motors[static_cast<std::size_t>(i)], s.bus_voltage_V));
      }
      ++k_;
      vehicle.carry({.p_WB_W_m = {0, 0, -10}});
      vehicle.step(1e-3);
      for (const auto& m : vehicle.state().motors) sum.thrust_N += m.thrust_N / ms;
      sum.battery_A += vehicle.state().battery_current_A / ms;
    }
    return sum;
  }

 private:
  int k_ = 0;
};

TEST(Sweep, HoverDrawsWhatTheVehiclesOwnControllersDrawInFlight) {
  const auto hover = hover_point(quad(), 0.0);
  ASSERT_TRUE(hover.ok());
  HeldInHover held;
  const double weight_N = held.params.vehicle.airframe.mass_kg * 9.80665;
  held.run(1000, 0);  // arms them
  int setpoint = 400;
  held.run(1500, setpoint);
  HeldInHover::Means means;
  for (int i = 0; i < 4; ++i) {
    means = held.run(300, setpoint);
    // A set-point is 1/2047 of 0.8 to 8 N for each motor.
    setpoint += static_cast<int>(std::lround((weight_N - means.thrust_N) / 4.0 / 7.2 * 2047.0));
  }
  EXPECT_TRUE(near(means.thrust_N, weight_N, stated(0.005 * weight_N, "a set-point's step")));
  EXPECT_TRUE(near(hover.value().total_A, means.battery_A,
                   stated(0.01 * means.battery_A,
                          "half of it the thrust's; the rest noise, counts of PWM, relaxation")));
}

// More torque at one speed: copper loss grows with its square, all else with less.
TEST(Sweep, ThePropellersBandReachesHoversCurrentAndTheTimeToEmpty) {
  const auto prop = catalogue::read_propeller_file(std::string(WHIRL_ROOT) +
                                                   "/test_plans/propellers/gwssf_11x4.7.lua");
  ASSERT_TRUE(prop.ok()) << prop.error().message();
  flight::FlightParams own = quad();
  EXPECT_FALSE(hover_point(own, 0.0).value().band);  // its polars have none
  own.blade = prop.value().blade;
  own.fit = prop.value().fit;
  const auto hover = hover_point(own, 0.0).value();
  ASSERT_TRUE(hover.band);
  const double half = 1.645 * plant::lifting_power_deviation(own.fit->axial, own.fit->belief,
                                                             hover.each.speed_radps);
  const double avionics_A = own.vehicle.avionics_current_A;
  const double more = (hover.band->most_A - avionics_A) / (hover.total_A - avionics_A);
  const double less = (hover.band->least_A - avionics_A) / (hover.total_A - avionics_A);
  EXPECT_GT(more, 1.0 + 0.8 * half);
  EXPECT_LT(more, (1.0 + half) * (1.0 + half));
  EXPECT_LT(less, 1.0 - 0.8 * half);
  EXPECT_GT(less, (1.0 - half) * (1.0 - half));
  EXPECT_TRUE(near(hover.band->shortest_s / hover.until_empty_s, hover.total_A / hover.band->most_A,
                   stated(0.05, "sag of the pack")));
  EXPECT_TRUE(near(hover.band->longest_s / hover.until_empty_s, hover.total_A / hover.band->least_A,
                   stated(0.05, "sag of the pack")));
}

// The current rises as the pack's voltage falls.
TEST(Sweep, ThePackIsEmptySoonerThanItsFirstCurrentPromises) {
  const auto hover = hover_point(quad(), 0.0);
  ASSERT_TRUE(hover.ok());
  const double promised_s = quad().vehicle.battery.capacity_C / hover.value().total_A;
  EXPECT_LT(hover.value().until_empty_s, 0.98 * promised_s);
  EXPECT_GT(hover.value().until_empty_s, 0.80 * promised_s);
}

// [Bangura2017]: 3950 rpm at 0.9 kg by its static thrust fit, 1.25 to 1.45 A of bus current.
TEST(Sweep, TheReferenceVehicleHoversWhereTheThesisSays) {
  const auto hover = drive_for_thrust(quad(), 0.9 * 9.80665 / 4.0, 16.4);
  ASSERT_TRUE(hover.ok());
  EXPECT_TRUE(near(hover.value().speed_radps * 30.0 / std::numbers::pi, 3950.0,
                   stated(80.0, "2 % of the fit of the static thrust")));
  EXPECT_TRUE(near(hover.value().bus_A, 1.35, stated(0.10, "1.25 to 1.45 A")));
}

TEST(Sweep, WhatNoVoltageLiftsIsAnError) {
  EXPECT_FALSE(drive_for_thrust(quad(), 100.0, 16.4).ok());
}

TEST(Sweep, NoStaticPointIsBetterThanAnIdealRotor) {
  for (const results::Chart& chart : propeller_sweep(quad().blade, {})) {
    if (chart.title != "Figure of merit") continue;
    ASSERT_EQ(chart.curves[0].y.size(), 37u);
    for (double merit : chart.curves[0].y) EXPECT_TRUE(merit > 0.3 && merit < 0.85) << merit;
  }
}

}  // namespace
}  // namespace whirl::sweep

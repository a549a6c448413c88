#include "harness/sweep/sweep.hpp"

#include <cmath>
#include <numbers>

#include "base/near.hpp"
#include "harness/catalogue/vehicle_file.hpp"
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

// Back-EMF, resistance: V = Ke w + R i, with the datasheet's Kv and what the thesis's points show of
// R on a running motor.
TEST(Sweep, TheMotorsVoltageEquationHolds) {
  const DrivePoint p = drive_point(quad(), 6.0, 16.4);
  const double ke = 60.0 / (2.0 * std::numbers::pi * 950.0);
  const double apparent_ohm = (p.voltage_V - ke * p.speed_radps) / p.winding_A;
  EXPECT_GT(apparent_ohm, 0.12);
  EXPECT_LT(apparent_ohm, 0.18);
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

#include "plant/battery/battery.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace whirl::plant {
namespace {

BatteryParams straight() {
  BatteryParams p;
  p.open_circuit = {{0.0, 16.0}, {1.0, 12.0}};
  p.capacity_C = 8000.0;
  p.relaxation_resistance_ohm = 0.05;
  p.relaxation_time_s = 20.0;
  return p;
}

TEST(Battery, SagsByTheRelaxationBranchAsItsExponentialSays) {
  Battery pack(straight());
  for (int k = 0; k < 1000; ++k) pack.draw(4.0 * 0.01, 0.01);  // 4 A for 10 s
  const double want = 16.0 - 4.0 * 40.0 / 8000.0 - 4.0 * 0.05 * (1.0 - std::exp(-0.5));
  EXPECT_TRUE(near(pack.source_V(), want, round_off(5000, 16.0)));
}

TEST(Battery, RecoversWhenRested) {
  Battery pack(straight());
  for (int k = 0; k < 1000; ++k) pack.draw(0.4, 0.1);
  for (int k = 0; k < 10000; ++k) pack.draw(0.0, 0.1);
  EXPECT_TRUE(near(pack.source_V(), 16.0 - 4.0 * 400.0 / 8000.0, stated(1e-6, "50 times over")));
}

TEST(Battery, ChargeTakenIsChargeBooked) {
  Battery pack(lipo_4s_2200());
  for (int k = 0; k < 3600; ++k) pack.draw(1.1, 1.0);
  EXPECT_TRUE(near(pack.depth_of_discharge(), 0.5, round_off(4000, 1.0)));
  for (int k = 0; k < 3600; ++k) pack.draw(-1.1, 1.0);  // and back
  EXPECT_TRUE(near(pack.open_circuit_V(), 16.8, stated(1e-9, "round-off of 7200 sums")));
}

TEST(Battery, LabSupplyNeverEmpties) {
  Battery supply(lab_supply(16.4, 0.01));
  supply.draw(1e6, 1.0);
  EXPECT_EQ(supply.source_V(), 16.4);
}

BatteryParams two_times() {
  BatteryParams p = straight();
  p.series_resistance_ohm = 0.03;
  p.slow_relaxation_resistance_ohm = 0.08;
  p.slow_relaxation_time_s = 200.0;
  return p;
}

TEST(Battery, TwoBranchesSagEachByItsOwnExponential) {
  Battery pack(two_times());
  for (int k = 0; k < 1000; ++k) pack.draw(4.0 * 0.1, 0.1);  // 4 A for 100 s
  const double sag_V = 4.0 * 0.05 * (1.0 - std::exp(-5.0)) + 4.0 * 0.08 * (1.0 - std::exp(-0.5));
  EXPECT_TRUE(near(pack.source_V(), 16.0 - 4.0 * 400.0 / 8000.0 - sag_V, round_off(5000, 16.0)));
}

// Into a branch of R and time T under a constant current go R I^2 (t - T (1 - exp(-t/T))).
TEST(Battery, WhatThePackGivesIsWorkAndHeatAndWhatItsBranchesTake) {
  Battery pack(two_times());
  BatteryBooks sum;
  double work_J = 0.0;
  for (int k = 0; k < 100000; ++k) {
    work_J += (pack.source_V() - pack.series_resistance_ohm() * 4.0) * 4.0 * 1e-3;
    sum += pack.draw(4.0 * 1e-3, 1e-3);
  }
  EXPECT_TRUE(near(sum.chemical_J, work_J + sum.series_J + sum.relaxation_J,
                   round_off(200000, sum.chemical_J)));
  const double fast_J = 0.05 * 16.0 * (100.0 - 20.0 * (1.0 - std::exp(-5.0)));
  const double slow_J = 0.08 * 16.0 * (100.0 - 200.0 * (1.0 - std::exp(-0.5)));
  EXPECT_TRUE(near(sum.series_J, 0.03 * 16.0 * 100.0, round_off(200000, 48.0)));
  EXPECT_TRUE(near(sum.relaxation_J, fast_J + slow_J, stated(1e-3, "half a step of 1 ms")));
}

TEST(Battery, ResistancesGoWithChargeAndTemperature) {
  BatteryParams p = two_times();
  p.resistance_over_depth = {{0.0, 1.0}, {0.5, 0.6}, {1.0, 2.0}};
  p.resistance_over_temperature = {{263.15, 3.0}, {298.15, 1.0}};
  p.temperature_K = 280.65;
  Battery pack(p);
  EXPECT_TRUE(near(pack.series_resistance_ohm(), 0.03 * 2.0, round_off(8, 0.06)));
  pack.draw(2000.0, 1.0);  // a quarter
  EXPECT_TRUE(near(pack.series_resistance_ohm(), 0.03 * 2.0 * 0.8, round_off(8, 0.06)));
  EXPECT_TRUE(near(pack.settled_resistance_ohm(), 0.16 * 2.0 * 0.8, round_off(8, 0.3)));
  p.temperature_K = 250.0;  // colder than anything told
  EXPECT_FALSE(validate(p, "pack").ok());
}

TEST(Battery, CurveMustNotRiseAsThePackIsEmptied) {
  BatteryParams p = straight();
  p.open_circuit.back().voltage_V = 16.1;
  EXPECT_FALSE(validate(p, "pack").ok());
}

TEST(Battery, CurveMustRunFromFullToEmpty) {
  BatteryParams p = straight();
  p.open_circuit.back().depth_of_discharge = 0.9;
  EXPECT_FALSE(validate(p, "pack").ok());
  p = straight();
  p.capacity_C = -1.0;
  EXPECT_FALSE(validate(p, "pack").ok());
  EXPECT_TRUE(validate(lipo_4s_2200(), "pack").ok());
  EXPECT_TRUE(validate(lab_supply(16.4, 0.0), "pack").ok());
}

}  // namespace
}  // namespace whirl::plant

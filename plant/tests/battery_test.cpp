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

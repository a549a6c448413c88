// What of the electrical power reaches the air.
#include "firmware/esc/core/power_balance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;

TEST(PowerBalance, IsTorqueTimesSpeedWhereTheBackEmfIsTheOnlyWitness) {
  const LossMap map{
      .loss_ohm = 0.0f, .loss_V = 0.0f, .share = 1.0f, .back_emf_Vs = -0.01f, .drag_Nm = 0.01f};
  EXPECT_TRUE(
      near(aerodynamic_power_W(map, 6.0f, 5.0f, 400.0f), 0.01f * (5.0f - 1.0f) * 400.0f,
           stated(1e-6 * std::abs(0.01f * (5.0f - 1.0f) * 400.0f), "a few ulp of a float")));
  EXPECT_TRUE(near(power_per_ampere_W(map, 6.0f, 5.0f, 400.0f), 0.01f * 400.0f,
                   stated(1e-6 * std::abs(0.01f * 400.0f), "a few ulp of a float")));
}

// 0.7 V of a diode: 6 V of a motor are half the time at 12 V and 0.4 of it at 15 V, so 0.35 V and 0.42 V are lost.
TEST(PowerBalance, ADiodeCarriesLessOnALowerBus) {
  const LossMap found{.bus_V = 15.0f};
  EXPECT_TRUE(near(freed_by_bus_V(found, 0.7f, 6.0f, 12.0f), 0.07, stated(1e-6, "float")));
  EXPECT_TRUE(near(freed_by_bus_V(found, 0.7f, 6.0f, 15.0f), 0.0, stated(1e-6, "float")));
  EXPECT_EQ(freed_by_bus_V(LossMap{}, 0.7f, 6.0f, 12.0f), 0.0f) << "not known";
}

TEST(PowerBalance, KnowsWhereTheCurrentHasGaps) {
  // 16 V at half duty on 40 uH: 5 A of ripple, so 2.5 A of mean current touch zero.
  const MotorConstants motor{.inductance_H = 40e-6f};
  EXPECT_TRUE(has_gaps(motor, 16.0f, 0.5f, 2.5f));
  EXPECT_FALSE(has_gaps(motor, 16.0f, 0.5f, 2.8f));
  EXPECT_FALSE(has_gaps(motor, 16.0f, 0.1f, 1.0f)) << "1.8 A of ripple";
}

}  // namespace
}  // namespace fw::esc

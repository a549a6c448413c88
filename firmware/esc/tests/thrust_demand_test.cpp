// The speed for a wanted thrust or power.
#include "firmware/esc/core/thrust_demand.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;

TEST(ThrustDemand, InvertsTheStaticMaps) {
  // A soft blade's [fit of the stand's propeller, 230 to 750 rad/s].
  const StaticMap map{
      .a3 = 4.5e-9f, .a2 = 1.1e-5f, .a1 = -1.0e-4f, .q4 = 1.4e-13f, .q3 = 2.0e-11f, .q2 = 1.65e-7f};
  for (float w : {200.0f, 450.0f, 700.0f}) {
    const float T = 0.8f * map.CT(w) * w * w, P = 0.9f * map.CP(w) * w * w * w;
    EXPECT_TRUE(near(speed_for_thrust_radps(map, T, 0.8f), w, stated(1e-4 * w, "float")));
    EXPECT_TRUE(near(speed_for_power_radps(map, P, 0.9f), w, stated(1e-4 * w, "Newton")));
  }
}

// From the last period's speed: there in two steps where it is near, and from the map where it is far.
TEST(ThrustDemand, BeginsWhereTheLastPeriodEnded) {
  const StaticMap map{
      .a3 = 4.5e-9f, .a2 = 1.1e-5f, .a1 = -1.0e-4f, .q4 = 1.4e-13f, .q3 = 2.0e-11f, .q2 = 1.65e-7f};
  for (float w : {200.0f, 450.0f, 700.0f}) {
    const float T = map.CT(w) * w * w, P = map.CP(w) * w * w * w;
    for (float share : {0.1f, 0.5f, 0.85f, 0.999f, 1.001f, 1.15f, 2.0f, 5.0f}) {
      const float from = share * w;
      // Twice from 15 % off leaves 1e-3, which the next period mends; from far away it does not begin
      // there at all.
      EXPECT_TRUE(near(speed_for_thrust_radps(map, T, 1.0f, from), w, stated(1e-3 * w, "Newton")))
          << share;
      EXPECT_TRUE(near(speed_for_power_radps(map, P, 1.0f, from), w, stated(1e-3 * w, "Newton")))
          << share;
    }
  }
}

}  // namespace
}  // namespace fw::esc

#include "plant/air/air.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

TEST(Air, StillByDefault) {
  Air air({}, 1);
  air.step(Vector3d::Zero(), Vector3d::Zero(), 1e-3);
  EXPECT_EQ(air.wind_W_mps({3.0, 4.0, -5.0}), Vector3d::Zero());
}

// Log law: speed grows by the same amount for every doubling of height.
TEST(Air, ShearGrowsByTheSameStepPerDoublingOfHeight) {
  AirParams params;
  params.steady_wind_W_mps = {0.0, 6.0, 0.0};
  params.shear_height_m = 16.0;
  params.roughness_length_m = 0.05;
  Air air(params, 1);
  auto east = [&](double h) { return air.wind_W_mps({0.0, 0.0, -h}).y(); };
  EXPECT_TRUE(near(east(16.0), 6.0, round_off(8, 6.0)));
  EXPECT_TRUE(near(east(8.0) - east(4.0), east(2.0) - east(1.0), round_off(64, 6.0)));
  EXPECT_EQ(east(0.05), 0.0);
  EXPECT_EQ(east(40.0), 6.0);
}

TEST(Air, GustRisesHoldsAndFallsWithSmoothEdges) {
  const GustWindow gust{.start_s = 1.0, .duration_s = 1.0, .edge_s = 0.2};
  EXPECT_EQ(window(gust, 0.999), 0.0);
  EXPECT_TRUE(near(window(gust, 1.1), 0.5, round_off(16, 1.0)));
  EXPECT_TRUE(near(window(gust, 1.05), 0.5 * (1.0 - std::sqrt(0.5)), round_off(16, 1.0)));
  EXPECT_EQ(window(gust, 1.5), 1.0);
  EXPECT_TRUE(near(window(gust, 1.9), 0.5, round_off(16, 1.0)));
  EXPECT_EQ(window(gust, 2.001), 0.0);
}

TEST(Air, JetBlowsUpwardInsideItsRadiusOnly) {
  AirParams params;
  params.jets.push_back({});
  Air air(params, 1);
  EXPECT_EQ(air.wind_W_mps({0.0, 0.0, -1.1}), Vector3d(0.0, 0.0, -3.5));  // up is -z
  EXPECT_EQ(air.wind_W_mps({0.2, -0.2, -1.1}), Vector3d(0.0, 0.0, -3.5));
  EXPECT_TRUE(near(air.wind_W_mps({0.35, 0.0, -1.1}).z(), -1.75, round_off(16, 3.5)));
  EXPECT_EQ(air.wind_W_mps({0.41, 0.0, -1.1}), Vector3d::Zero());
}

TEST(Air, TurbulenceIsTheSameForTheSameSeedOnly) {
  AirParams params;
  params.dryden.wind_at_6m_mps = 5.0;
  Air a(params, 1), b(params, 1), c(params, 2);
  for (Air* air : {&a, &b, &c}) {
    for (int k = 0; k < 100; ++k) air->step({0, 0, -10}, {5, 0, 0}, 1e-2);
  }
  EXPECT_EQ(a.wind_W_mps({0, 0, -10}), b.wind_W_mps({0, 0, -10}));
  EXPECT_NE(a.wind_W_mps({0, 0, -10}), c.wind_W_mps({0, 0, -10}));
}

// Each rotor feels its own wind: a gust rate shows as a difference across the vehicle.
TEST(Air, GustRatesDifferAcrossTheVehicle) {
  AirParams params;
  params.dryden.wind_at_6m_mps = 5.0;
  Air air(params, 1);
  for (int k = 0; k < 100; ++k) air.step({0, 0, -10}, {5, 0, 0}, 1e-2);
  EXPECT_NE(air.wind_W_mps({0.25, 0, -10}), air.wind_W_mps({-0.25, 0, -10}));
}

}  // namespace
}  // namespace whirl::plant

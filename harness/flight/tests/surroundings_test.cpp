#include "harness/flight/surroundings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "base/near.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/flight/flight_world.hpp"
#include "harness/flight/tests/paths.hpp"
#include "harness/lua/table.hpp"
#include "harness/plan/requests.hpp"

namespace whirl::flight {
namespace {

FlightParams hp_quad_at(const Eigen::Vector3d& p_W_m) {
  auto params =
      catalogue::read_vehicle(std::string(kSourceFolder) + "/test_plans/vehicles/hp_quad.lua");
  EXPECT_TRUE(params.ok());
  params.value().place.start = Start{.p_WB_W_m = p_W_m};
  return params.value();
}

std::optional<double> value(const FlightWorld& world, const std::string& name) {
  std::vector<double> values(world.signals().size());
  world.read(values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (world.signals()[i].name == name) return values[i];
  }
  return std::nullopt;
}

TEST(Surroundings, FenceSignalsAreThoseOfThePlanAndMissingWithoutOne) {
  FlightParams params = hp_quad_at({0.0, 1.5, -1.0});
  const FlightWorld in(params, 1);
  EXPECT_EQ(value(in, "fence_margin"), 0.5);
  EXPECT_EQ(value(in, "inside_fence"), 1.0);
  const FlightWorld out(hp_quad_at({0.0, 2.25, -1.0}), 1);
  EXPECT_EQ(value(out, "fence_margin"), -0.25);
  EXPECT_EQ(value(out, "inside_fence"), 0.0);
  params.place.fence.reset();
  EXPECT_FALSE(value(FlightWorld(params, 1), "inside_fence"));
}

TEST(Surroundings, AMagnetsFieldFallsWithTheCubeOfTheDistanceAndEnds) {
  Surroundings place;
  place.magnetic_field_W_T.setZero();
  place.magnets.push_back(
      {.field_W_T = {8e-6, 0.0, 0.0}, .p_W_m = {1.0, 0.0, 0.0}, .radius_m = 0.5, .end_ns = 1000});
  place.magnets.push_back({.field_W_T = {0.0, 0.0, 3e-6}});
  EXPECT_EQ(place.field_W_T({1.0, 0.4, 0.0}, 0), Eigen::Vector3d(8e-6, 0.0, 3e-6));
  EXPECT_EQ(place.field_W_T({1.0, -1.0, 0.0}, 0), Eigen::Vector3d(1e-6, 0.0, 3e-6));
  EXPECT_EQ(place.field_W_T({1.0, 0.4, 0.0}, 1000), Eigen::Vector3d(0.0, 0.0, 3e-6));
}

TEST(Surroundings, AMagnetOfThePlanIsWhatTheBoardFeels) {
  FlightWorld world(hp_quad_at({0.0, 0.0, -1.0}), 1);
  const auto read = lua::read_text(
      "return { magnet = { field = { east = '20 uT' }, at = { height = '2 m' }, radius = '50 cm', "
      "duration = '1 s' } }",
      "plan.lua");
  ASSERT_TRUE(plan::disturb(world, read.value(), 0).ok());
  io::Batch happened, sensed;
  world.step(0, happened, sensed);
  for (io::Reader r(sensed.bytes()); r.next();) {
    if (r.header().kind != io::Kind::body_motion) continue;
    EXPECT_TRUE(near(r.as<io::BodyMotion>().magnetic_field_B_T[1], 5.1e-6 + 20e-6 / 8.0,
                     round_off(8, 3e-5)));  // 1 m away, twice the radius
  }
  const auto lost =
      lua::read_text("return { magnet = { field = {}, radius = '1 m' } }", "plan.lua");
  EXPECT_FALSE(plan::disturb(world, lost.value(), 0).ok());
}

TEST(Surroundings, TheBoardFeelsFieldUnbalanceAndFreeFall) {
  FlightParams params = hp_quad_at({0.0, 0.0, -1.0});
  params.place.magnetic_field_W_T = {1e-5, 2e-5, 3e-5};
  params.vehicle.airframe.rotors[1].unbalance_kgm = 1e-6;
  FlightWorld world(params, 1);
  io::Batch happened, sensed;
  world.step(0, happened, sensed);
  bool seen = false;
  for (io::Reader r(sensed.bytes()); r.next();) {
    if (r.header().kind != io::Kind::body_motion) continue;
    seen = true;
    const auto motion = r.as<io::BodyMotion>();
    EXPECT_EQ(motion.magnetic_field_B_T[1], 2e-5);  // nose north, level
    EXPECT_EQ(motion.rotor_unbalance_m[1], 1e-6 / 0.9);
    EXPECT_EQ(motion.rotor_unbalance_m[0], 0.0);
    EXPECT_EQ(motion.specific_force_B_mps2[2], 0.0);  // and in the air
  }
  EXPECT_TRUE(seen);
}

}  // namespace
}  // namespace whirl::flight

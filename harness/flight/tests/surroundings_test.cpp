#include "harness/flight/surroundings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "harness/catalogue/vehicle_file.hpp"
#include "harness/flight/flight_world.hpp"
#include "harness/flight/tests/paths.hpp"

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

TEST(Surroundings, TheBoardFeelsTheFieldOfThePlace) {
  FlightParams params = hp_quad_at({0.0, 0.0, -1.0});
  params.place.magnetic_field_W_T = {1e-5, 2e-5, 3e-5};
  FlightWorld world(params, 1);
  io::Batch happened, sensed;
  world.step(0, happened, sensed);
  bool seen = false;
  for (io::Reader r(sensed.bytes()); r.next();) {
    if (r.header().kind != io::Kind::body_motion) continue;
    seen = true;
    const auto motion = r.as<io::BodyMotion>();
    EXPECT_EQ(motion.magnetic_field_B_T[1], 2e-5);    // nose north, level
    EXPECT_EQ(motion.specific_force_B_mps2[2], 0.0);  // and in the air
  }
  EXPECT_TRUE(seen);
}

}  // namespace
}  // namespace whirl::flight

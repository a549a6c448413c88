#include "harness/flight/receiver.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"

namespace whirl::flight {
namespace {

constexpr double kRad = M_PI / 180.0;

io::MavlinkFrame origin(std::int32_t latitude_e7, std::int32_t longitude_e7, std::int32_t mm) {
  io::MavlinkSender sender{1, 1, 0};
  io::GpsGlobalOrigin told;
  told.latitude = latitude_e7;
  told.longitude = longitude_e7;
  told.altitude = mm;
  return io::pack(told, sender);
}

TEST(Receiver, KnowsNothingBeforeItWasTold) {
  Receiver receiver;
  EXPECT_TRUE(std::isnan(receiver.error_W_m().x()));
  receiver.on_solution({}, 1'000'000'000);
  EXPECT_EQ(receiver.error_W_m().x(), 0.0);
  EXPECT_TRUE(std::isnan(receiver.period_s()));
  receiver.on_solution({}, 1'200'000'000);
  receiver.on_solution({}, 2'200'000'000);
  EXPECT_TRUE(near(receiver.period_s(), 1.0, stated(1e-12, "rounding")));
  EXPECT_TRUE(std::isnan(receiver.place_m({0, 0, 0}).x()));
}

// A degree of latitude is 110 574 m long at the equator, one of longitude 111 320 m (WGS84).
TEST(Receiver, SeesTheVehicleInTheVehiclesOwnFrame) {
  Receiver receiver;
  receiver.hear(origin(0, 10'0000000, 5000));
  io::GnssSolution solution{.latitude_rad = 1e-4 * kRad, .longitude_rad = 9.9998 * kRad};
  // The world's origin is another one: only what the vehicle has moved since the solution counts.
  solution.p_WB_W_m[0] = 500.0;
  solution.p_error_W_m[0] = 3.0;
  receiver.on_solution(solution, 0);
  const Eigen::Vector3d at_fix_m(497.0, 0.0, 0.0);
  const Eigen::Vector3d seen_m = receiver.place_m(at_fix_m + Eigen::Vector3d(0.0, 2.0, -1.0));
  EXPECT_TRUE(near(seen_m.x(), 11.057, stated(1e-3, "printed metres")));
  EXPECT_TRUE(near(seen_m.y(), -22.264 + 2.0, stated(1e-3, "printed metres")));
  EXPECT_TRUE(near(seen_m.z(), 5.0 - 1.0, stated(1e-3, "curvature in 25 m")));
  EXPECT_EQ(receiver.error_W_m().x(), 3.0);
}

}  // namespace
}  // namespace whirl::flight

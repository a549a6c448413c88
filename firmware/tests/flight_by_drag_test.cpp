// Velocity commands flown on without motion capture, around the rigid body of vehicle_model.hpp.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "firmware/tests/vehicle_model.hpp"

namespace fw::test {
namespace {

using whirl::near, whirl::stated;

struct Teleoperated {
  Teleoperated() : vehicle({}) {
    for (const Parameter width : {Parameter::fence_north_m, Parameter::fence_east_m}) {
      flight.parameters().set(width, 0.0f);
    }
    vehicle.run(flight, 3.0);
    EXPECT_EQ(flight.arm(), Reason::none) << text_of(flight.ready_to_arm());
    vehicle.run(flight, 1.0);
    EXPECT_EQ(flight.take_off(1.1f), Reason::none);
    vehicle.run(flight, 8.0);
  }
  // As the ground station does, ten times a second.
  void fly(const Vector3& v_W_mps, double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 10.0); ++i) {
      flight.on_velocity(v_W_mps, -1.1f, 0.0f);
      vehicle.run(flight, 0.1);
    }
  }
  Flight flight;
  VehicleModel vehicle;
};

TEST(FlightByDrag, HoldsCommandedVelocitiesAndTheHeightWithoutCapture) {
  Teleoperated t;
  t.vehicle.wind_W_ = {1.0, -0.5, 0.0};
  for (int i = 0; i < 4; ++i) t.fly({i % 2 == 0 ? 0.6f : -0.6f, 0.0f, 0.0f}, 5.0);
  t.vehicle.capture_on_ = false;
  for (int i = 0; i < 8; ++i) {
    const float way = i % 2 == 0 ? 0.6f : -0.6f;
    t.fly({way, 0.3f * way, 0.0f}, 5.0);
    EXPECT_TRUE(near(t.vehicle.v_W_.x(), way, stated(0.3, "what is asked of it")));
    EXPECT_TRUE(near(t.vehicle.v_W_.y(), 0.3 * way, stated(0.3, "what is asked of it")));
    EXPECT_TRUE(near(t.vehicle.p_W_.z(), -1.1, stated(0.3, "what is asked of it")));
  }
  EXPECT_EQ(t.flight.estimator().velocity_source(), VelocitySource::drag);
  EXPECT_EQ(t.flight.state(), FlightState::flying);
}

TEST(FlightByDrag, EndsAfterAMinute) {
  Teleoperated t;
  t.fly({0.2f, 0.0f, 0.0f}, 2.0);
  t.vehicle.capture_on_ = false;
  t.fly({0.0f, 0.0f, 0.0f}, 58.0);
  EXPECT_EQ(t.flight.state(), FlightState::flying);
  t.fly({0.0f, 0.0f, 0.0f}, 4.0);
  EXPECT_EQ(t.flight.state(), FlightState::failsafe);
  EXPECT_EQ(t.flight.last_reason(), Reason::no_position);
}

TEST(FlightByDrag, IsNotForWhoHoldsAPlace) {
  Teleoperated t;
  t.vehicle.capture_on_ = false;
  t.vehicle.run(t.flight, 1.0);
  EXPECT_EQ(t.flight.state(), FlightState::failsafe);
}

TEST(FlightByDrag, NeedsTheBarometerAndTheMagnetometer) {
  Teleoperated t;
  t.fly({0.2f, 0.0f, 0.0f}, 2.0);
  t.vehicle.pressure_on_ = t.vehicle.field_on_ = false;
  t.vehicle.capture_on_ = false;
  t.fly({0.2f, 0.0f, 0.0f}, 1.0);
  EXPECT_EQ(t.flight.state(), FlightState::failsafe);
}

TEST(FlightByDrag, TheCapturesReturnMovesThePlaceAndNotTheVehicle) {
  Teleoperated t;
  t.fly({0.2f, 0.0f, 0.0f}, 5.0);
  t.vehicle.capture_on_ = false;
  t.vehicle.wind_W_ = {0.5, 0.0, 0.0};  // is not noticed: the vehicle drifts along with it
  t.fly({0.0f, 0.0f, 0.0f}, 10.0);
  const double drift_m =
      (t.flight.estimator().p_WB_W_m().cast<double>() - t.vehicle.p_W_).head<2>().norm();
  EXPECT_GT(drift_m, 1.0);
  t.vehicle.capture_on_ = true;
  double steepest_rad = 0.0;
  for (int i = 0; i < 20; ++i) {
    t.fly({0.0f, 0.0f, 0.0f}, 0.1);
    steepest_rad = std::max(steepest_rad, t.vehicle.tilt_rad());
  }
  EXPECT_LT(steepest_rad, 0.18);  // 0.5 m/s are braked, not a drift of metres
  t.fly({0.0f, 0.0f, 0.0f}, 3.0);
  EXPECT_LT((t.flight.estimator().p_WB_W_m().cast<double>() - t.vehicle.p_W_).norm(), 0.05);
  EXPECT_LT(t.vehicle.v_W_.norm(), 0.15);
}

}  // namespace
}  // namespace fw::test

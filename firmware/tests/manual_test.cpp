// Flown by hand: the whole flight logic around the rigid body of vehicle_model.hpp, with sticks as frames.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "firmware/drivers/cppm_receiver.hpp"
#include "firmware/flight/manual.hpp"
#include "firmware/tests/vehicle_model.hpp"

namespace fw::test {
namespace {

using whirl::near, whirl::stated;

struct Hand {
  float roll = 0, pitch = 0, throttle = 0, yaw = 0;  // -1..1, throttle 0..1
  int mode = 2;
  bool arm = false, on = true;
};

struct ManualRig {
  explicit ManualRig(int mode) { hand.mode = mode; }

  void run(double seconds) {
    for (long ms = std::lround(seconds * 1000.0); ms > 0; --ms) {
      if (hand.on && ms % 22 == 0) flight.on_rc(frame().channels());
      vehicle.step(flight);
    }
  }
  CppmFrame frame() const {
    const auto us = [](float share) {
      return static_cast<std::uint16_t>(1500.0f + 500.0f * share);
    };
    CppmFrame f;
    f.channels_us = {us(hand.roll),
                     us(hand.pitch),
                     us(2.0f * hand.throttle - 1.0f),
                     us(hand.yaw),
                     us(static_cast<float>(hand.mode - 2)),
                     us(hand.arm ? 1.0f : -1.0f)};
    f.count = 6;
    return f;
  }
  void arm() {
    run(3.5);
    hand.arm = true;
    run(2.5);
    ASSERT_EQ(flight.state(), FlightState::armed) << text_of(flight.last_reason());
  }
  double height_m() const { return -vehicle.p_W_.z() - VehicleModel::kFoot_m; }

  Hand hand;
  Flight flight;
  VehicleModel vehicle{{}};
};

TEST(Manual, TheThrottleMustBeLowToArmAndToStopTheMotors) {
  ManualRig rig(2);
  rig.hand.throttle = 0.3f;
  rig.run(3.5);
  rig.hand.arm = true;
  rig.run(0.5);
  EXPECT_EQ(rig.flight.state(), FlightState::disarmed);
  EXPECT_EQ(rig.flight.last_reason(), Reason::throttle_high);
  rig.hand.throttle = 0.0f;
  rig.run(0.5);
  EXPECT_EQ(rig.flight.state(), FlightState::disarmed);  // the switch has to be moved again
  rig.hand.arm = false;
  rig.run(0.2);
  rig.hand.arm = true;
  rig.run(0.2);
  EXPECT_EQ(rig.flight.state(), FlightState::armed);
  rig.hand.throttle = 0.3f;
  rig.hand.arm = false;
  rig.run(0.5);
  EXPECT_EQ(rig.flight.state(), FlightState::armed);
  rig.hand.throttle = 0.0f;
  rig.run(0.2);
  EXPECT_EQ(rig.flight.state(), FlightState::disarmed);
}

TEST(Manual, ASwitchThatIsOnFromTheBeginningArmsNothing) {
  ManualRig rig(2);
  rig.hand.arm = true;
  rig.run(5.0);
  EXPECT_EQ(rig.flight.state(), FlightState::disarmed);
}

TEST(Manual, FliesByVelocityAndNobodyElsesTargetsCount) {
  ManualRig rig(2);
  rig.arm();
  EXPECT_EQ(rig.flight.take_off(1.0f), Reason::by_hand);
  rig.hand.throttle = 1.0f;
  rig.run(4.0);
  rig.hand.throttle = 0.5f;
  rig.run(3.0);
  const double height_m = rig.height_m();
  EXPECT_GT(height_m, 0.5);
  rig.flight.on_target({0.0f, 0.0f, 0.0f}, 0.0f);
  rig.hand.pitch = -0.5f;
  rig.run(2.0);
  EXPECT_EQ(rig.flight.state(), FlightState::flying);
  EXPECT_TRUE(near(rig.height_m(), height_m, stated(0.1, "held within 10 cm")));
  EXPECT_TRUE(near(rig.vehicle.v_W_.x(), 0.5 * config::kSpeedLimit_mps,
                   stated(0.15, "a quarter: dead zone, drag and bias")));
}

TEST(Manual, LandsByThrottleAndIdlesUntilTheSwitchSaysSo) {
  ManualRig rig(2);
  rig.arm();
  rig.hand.throttle = 1.0f;
  rig.run(4.0);
  rig.hand.throttle = 0.0f;
  rig.run(12.0);
  EXPECT_LT(rig.height_m(), 0.02);
  EXPECT_EQ(rig.flight.state(), FlightState::armed);
  EXPECT_EQ(rig.flight.last_reason(), Reason::landed);
  rig.hand.arm = false;
  rig.run(0.2);
  EXPECT_EQ(rig.flight.state(), FlightState::disarmed);
}

class Lost : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(ByAttitudeAndVelocity, Lost, ::testing::Values(1, 2));

TEST_P(Lost, LandsHalfASecondAfterTheReceiverFellSilent) {
  ManualRig rig(2);
  rig.arm();
  rig.hand.throttle = 1.0f;
  rig.run(4.0);
  rig.hand.throttle = 0.5f;
  rig.run(2.0);
  rig.hand.mode = GetParam();
  rig.run(0.5);
  ASSERT_EQ(rig.flight.state(), FlightState::flying);
  rig.hand.on = false;
  rig.run(0.55);
  EXPECT_EQ(rig.flight.state(), FlightState::landing);
  EXPECT_EQ(rig.flight.last_reason(), Reason::rc_lost);
  rig.run(15.0);
  EXPECT_EQ(rig.flight.state(), FlightState::disarmed);
}

TEST(Manual, NonsenseEndsItLikeSilence) {
  ManualRig rig(2);
  rig.arm();
  rig.hand.throttle = 1.0f;
  rig.run(4.0);
  rig.hand.throttle = -0.1f;  // 900 us: the receiver's own failsafe
  rig.run(0.6);
  EXPECT_EQ(rig.flight.state(), FlightState::landing);
  EXPECT_EQ(rig.flight.last_reason(), Reason::rc_nonsense);
}

}  // namespace
}  // namespace fw::test

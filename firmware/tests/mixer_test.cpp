// Oracle: the forward geometry, torque as r x F and the reaction of each rotor's drag.
#include "firmware/control/mixer.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"

namespace fw {
namespace {

using whirl::near, whirl::stated;

// What four thrusts do to the airframe: rotors at +x, +y, -x, -y (0.25 m), thrust along -z; 1 and 3
// turn counter-clockwise seen from above, so their reaction is clockwise: +z (down) in FRD.
Eigen::Vector3d torque_of(const RotorThrusts& thrusts) {
  const Eigen::Vector3d arms[4] = {{0.25, 0, 0}, {0, 0.25, 0}, {-0.25, 0, 0}, {0, -0.25, 0}};
  const double reaction[4] = {1, -1, 1, -1};
  Eigen::Vector3d sum(0, 0, 0);
  for (unsigned i = 0; i < 4; ++i) {
    sum += arms[i].cross(Eigen::Vector3d(0, 0, -thrusts[i]));
    sum.z() += reaction[i] * 0.0165 * thrusts[i];
  }
  return sum;
}

double total_of(const RotorThrusts& t) {
  return double{t[0]} + t[1] + t[2] + t[3];
}

TEST(Mixer, ThrustsProduceTheTorqueAskedFor) {
  const Vector3 asked(0.12f, -0.2f, 0.01f);
  const RotorThrusts thrusts = mix(8.8f, asked);
  const whirl::Tolerance tolerance = stated(1e-5, "float round-off of a few newtons");
  EXPECT_TRUE(near(total_of(thrusts), 8.8, tolerance));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(near(torque_of(thrusts)[i], asked[i], tolerance)) << i;
}

TEST(Mixer, RollingRightSpeedsUpTheLeftRotor) {
  const RotorThrusts thrusts = mix(8.8f, {0.1f, 0.0f, 0.0f});
  EXPECT_GT(thrusts[3], thrusts[1]);
  EXPECT_EQ(thrusts[0], thrusts[2]);
}

TEST(Mixer, NosingUpSpeedsUpTheFrontRotor) {
  const RotorThrusts thrusts = mix(8.8f, {0.0f, 0.1f, 0.0f});
  EXPECT_GT(thrusts[0], thrusts[2]);
}

TEST(Mixer, YawGivesWayToRollAndPitch) {
  const Vector3 asked(0.6f, 0.6f, 0.2f);
  const RotorThrusts thrusts = mix(8.8f, asked);
  const Eigen::Vector3d got = torque_of(thrusts);
  EXPECT_TRUE(near(got.x(), 0.6, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(got.y(), 0.6, stated(1e-5, "float round-off")));
  EXPECT_LT(got.z(), 0.1);
}

TEST(Mixer, BeyondTheLimitsTheTorqueKeepsItsAxis) {
  const RotorThrusts thrusts = mix(8.8f, {3.0f, 1.5f, 0.0f});
  const Eigen::Vector3d got = torque_of(thrusts);
  EXPECT_TRUE(near(got.x() / got.y(), 2.0, stated(1e-4, "float round-off")));
  for (const float thrust : thrusts) {
    EXPECT_GE(thrust, 0.8f - 1e-6f);
    EXPECT_LE(thrust, 8.0f);
  }
}

// Hover leaves 1.4 N below each rotor: 0.7 N m by one pair alone. Carrying 3.2 N each, the pair has 2.4 N.
TEST(Mixer, APairAtItsLowerLimitCarriesMore) {
  const RotorThrusts thrusts = mix(8.8f, {0.0f, 1.1f, 0.0f});
  const Eigen::Vector3d got = torque_of(thrusts);
  EXPECT_TRUE(near(got.y(), 1.1, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(got.x(), 0.0, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(thrusts[2], 0.8, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(thrusts[0], 5.2, stated(1e-5, "float round-off")));
  // The pair carries 1.6 N more than its half; the other one gives 0.3 of that back.
  EXPECT_TRUE(near(total_of(thrusts), 8.8 + 0.7 * 1.6, stated(1e-5, "float round-off")));
}

TEST(Mixer, WhereNoPairHasMoreToCarryTheThrustKeepsItsSize) {
  const RotorThrusts thrusts = mix(8.8f, {3.0f, 3.0f, 0.0f});
  EXPECT_TRUE(near(total_of(thrusts), 8.8, stated(1e-5, "float round-off")));
}

// Half a newton more on each of the two, 0.3 of it less on each of the others.
TEST(Mixer, APairThatIsLiftedCarriesMoreAndTheOtherOneLess) {
  const PairLifts lifts{.fore_and_aft_N = 0.5f};
  const RotorThrusts thrusts = mix(8.8f, {0.0f, 0.3f, 0.0f}, all_thrusts(), lifts);
  const Eigen::Vector3d got = torque_of(thrusts);
  EXPECT_TRUE(near(got.y(), 0.3, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(got.x(), 0.0, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(0.5 * (double{thrusts[0]} + thrusts[2]), 2.7, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(total_of(thrusts), 8.8 + 0.7, stated(1e-5, "float round-off")));
}

// 1.5 of half the difference: 20 rad/s^2 of 0.0125 kg m^2 at two arms of 0.25 m take 0.5 N beside each rotor's mean.
TEST(Mixer, ATurnNowOrInTheNextHoldLiftsItsPair) {
  ThrustAndAttitude wanted;
  wanted.w_dot_B_radps2 = {-20.0f, 5.0f, 30.0f};
  wanted.next_w_dot_B_radps2 = {5.0f, -40.0f, 0.0f};
  const PairLifts lifts = lifts_for(wanted);
  EXPECT_TRUE(near(lifts.across_N, 1.5 * 0.5, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(lifts.fore_and_aft_N, 1.5 * 1.0, stated(1e-5, "float round-off")));
}

TEST(Mixer, YawAloneNeverCostsThrust) {
  const RotorThrusts thrusts = mix(8.8f, {0.0f, 0.0f, 0.5f});
  EXPECT_TRUE(near(total_of(thrusts), 8.8, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(thrusts[1], 0.8, stated(1e-5, "float round-off")));
}

// A rotor that cannot slow down at once: its partner has to make the torque.
TEST(Mixer, WithinTheRangesTheTorqueComesFirst) {
  ThrustRanges ranges = all_thrusts();
  ranges[2] = {2.0f, 2.4f};
  const RotorThrusts thrusts = mix(8.8f, {0.0f, 0.3f, 0.0f}, ranges);
  EXPECT_TRUE(near(torque_of(thrusts).y(), 0.3, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(thrusts[2], 2.0, stated(1e-5, "float round-off")));
  ranges[0] = {2.0f, 2.5f};
  EXPECT_TRUE(near(torque_of(mix(8.8f, {0.0f, 0.3f, 0.0f}, ranges)).y(), 0.25 * 0.5,
                   stated(1e-5, "float round-off")));
}

TEST(Mixer, AHalfOfTheThrottleHoversAndItsEndsAreTheRotors) {
  EXPECT_TRUE(whirl::near(collective_N(0.5f, 9.0f), 9.0, whirl::stated(1e-5, "floats")));
  EXPECT_TRUE(whirl::near(collective_N(0.0f, 9.0f), 4.0f * 0.8f, whirl::stated(1e-5, "floats")));
  EXPECT_TRUE(whirl::near(collective_N(1.0f, 9.0f), 4.0f * 6.0f, whirl::stated(1e-5, "floats")));
  EXPECT_TRUE(whirl::near(collective_N(0.75f, 9.0f), 16.5, whirl::stated(1e-5, "floats")));
}

// Ends of the range on the wire: v = 1 asks for 0.8 N, v = 2047 for 8 N; steps of 3.5 mN.
TEST(Mixer, SetpointsSpanTheRangeOfTheEsc) {
  EXPECT_EQ(setpoint_for(0.0f), 1);
  EXPECT_EQ(setpoint_for(0.8f), 1);
  EXPECT_EQ(setpoint_for(8.0f), 2047);
  EXPECT_EQ(setpoint_for(99.0f), 2047);
  const double asked = 0.8 + (setpoint_for(2.207f) - 1) / 2046.0 * 7.2;
  EXPECT_TRUE(near(asked, 2.207, whirl::counts(0.5, 7.2 / 2046.0)));
}

}  // namespace
}  // namespace fw

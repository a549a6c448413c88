// The profile between an attitude that is asked for and what the vehicle is asked to do; and what the
// rotors can do of it. Oracles: sums of what comes out, the limits as they are stated, forward integration.
#include "firmware/control/attitude_reference.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"
#include "firmware/control/rotor_response.hpp"

namespace fw {
namespace {

using whirl::near, whirl::stated;
constexpr float kStep_s = 0.005f, kDegree = kPi / 180.0f;

float roll_of(const Quaternion& q) {
  return 2.0f * std::atan2(q.x(), q.w());
}

TEST(AttitudeReference, AStepIsAnSThatEndsWhereItWasAskedWithin250ms) {
  AttitudeReference reference;
  reference.start(Quaternion::Identity());
  float last = 0.0f, last_alpha = 0.0f, largest_change = 0.0f, t10 = 0.0f, t90 = 0.0f;
  ThrustAndAttitude wanted;
  for (int i = 1; i <= 50; ++i) {
    reference.step({.roll_rad = 20.0f * kDegree}, true);
    const float rate_before = wanted.w_B_radps.x();
    reference.put(wanted);
    const float roll = roll_of(wanted.q_WB);
    EXPECT_GE(roll, last - 1e-6f);
    const float alpha = (wanted.w_B_radps.x() - rate_before) / kStep_s;
    largest_change = std::max(largest_change, std::abs(alpha - last_alpha));
    const auto passes = [&](float share) {  // within this step, or later
      return kStep_s * (static_cast<float>(i) - (roll - share * 20.0f * kDegree) / (roll - last));
    };
    if (last < 2.0f * kDegree && roll > last) t10 = passes(0.1f);
    if (last < 18.0f * kDegree && roll > last) t90 = passes(0.9f);
    last = roll;
    last_alpha = alpha;
  }
  EXPECT_TRUE(near(last, 20.0f * kDegree, stated(1e-5, "float round-off")));
  EXPECT_TRUE(near(wanted.w_B_radps.x(), 0.0, stated(1e-3, "float round-off over 5 ms")));
  EXPECT_LT(t90 - t10, 0.1f);
  // Continuous acceleration: 1700 rad/s^3 at most, twice that where two means turn at once.
  EXPECT_LT(largest_change, 2.0f * 1700.0f * kStep_s);
}

// What the rotors are asked for in each hold of 20 ms, summed up, turns the vehicle as the profile says.
TEST(AttitudeReference, TheHeldAccelerationsIntegrateToTheProfile) {
  AttitudeReference reference;
  reference.start(Quaternion::Identity());
  ThrustAndAttitude wanted;
  float held = 0.0f, rate = 0.0f, roll = 0.0f, worst = 0.0f;
  for (int i = 0; i < 60; ++i) {
    reference.step({.roll_rad = 10.0f * kDegree}, true);
    reference.put(wanted);
    worst = std::max(worst, std::abs(roll - roll_of(wanted.q_WB)));
    if (i % 4 == 0) held = wanted.w_dot_B_radps2.x();
    roll += kStep_s * (rate + 0.5f * kStep_s * held);
    rate += kStep_s * held;
  }
  EXPECT_TRUE(near(rate, 0.0, stated(0.01, "0.4 % of the largest rate")));
  EXPECT_TRUE(near(roll, 10.0f * kDegree, stated(0.01, "0.6 deg: steps of a hold")));
  EXPECT_LT(worst, 1.5f * kDegree);
}

TEST(AttitudeReference, ADemandWaitsUntilItIsTaken) {
  AttitudeReference reference;
  reference.start(Quaternion::Identity());
  ThrustAndAttitude wanted;
  for (int i = 0; i < 100; ++i) reference.step({.roll_rad = 20.0f * kDegree}, false);
  reference.put(wanted);
  EXPECT_TRUE(near(wanted.q_WB.w(), 1.0, stated(1e-6, "single floats")));
  reference.step({.roll_rad = 20.0f * kDegree}, true);
  for (int i = 0; i < 100; ++i) reference.step({}, false);
  reference.put(wanted);
  EXPECT_TRUE(
      near(2.0 * std::asin(wanted.q_WB.x()), 20.0 * kDegree, stated(1e-4, "single floats")));
}

// What is told of the next hold is what the next one asks for.
TEST(AttitudeReference, TellsOfEachHoldBeforeItComes) {
  AttitudeReference reference;
  reference.start(Quaternion::Identity());
  ThrustAndAttitude wanted;
  float told = 0.0f, largest = 0.0f;
  for (int i = 0; i < 60; ++i) {
    reference.step({.roll_rad = 10.0f * kDegree}, true);
    reference.put(wanted);
    if (i % 4 != 0) continue;
    EXPECT_TRUE(near(wanted.w_dot_B_radps2.x(), told, stated(1e-4, "the same sums"))) << i;
    told = wanted.next_w_dot_B_radps2.x();
    largest = std::max(largest, std::abs(told));
  }
  EXPECT_GT(largest, 20.0f);
}

// The same about the vertical: the rate that the held accelerations add up to is the one that was
// asked for, and so is the heading.
TEST(AttitudeReference, TheHeldAccelerationsOfAYawIntegrateToTheProfile) {
  AttitudeReference reference;
  reference.start(Quaternion::Identity());
  ThrustAndAttitude wanted;
  float held = 0.0f, rate = 0.0f, yaw = 0.0f, worst = 0.0f, worst_rate = 0.0f;
  for (int i = 0; i < 400; ++i) {
    reference.step({.yaw_rate_radps = i < 200 ? 1.0f : 0.0f}, true);
    reference.put(wanted);
    worst = std::max(worst, std::abs(wrap_pi(yaw - yaw_of(wanted.q_WB))));
    worst_rate = std::max(worst_rate, std::abs(rate - wanted.w_B_radps.z()));
    if (i % 4 == 0) held = wanted.w_dot_B_radps2.z();
    yaw += kStep_s * (rate + 0.5f * kStep_s * held);
    rate += kStep_s * held;
    if (i != 199) continue;
    EXPECT_TRUE(near(rate, 1.0, stated(0.01, "1 % of the rate")));
  }
  EXPECT_TRUE(near(rate, 0.0, stated(0.01, "1 % of the rate")));
  // On and off for the same time: a second at 1 rad/s, whatever the ramps.
  EXPECT_TRUE(near(yaw, 1.0, stated(0.02, "2 %: steps of a hold")));
  EXPECT_LT(worst, 1.5f * kDegree);
  EXPECT_LT(worst_rate, 0.06f);  // a hold of 20 ms at 2.5 rad/s2
}

// Four rotors of 2.2 N in hover, each 0.8 N at least: two that go down to that while the other two rise by the
// same make 4 x 1.4 N times 0.0175 m, 0.098 N m about the vertical. No more may be asked for, and not much less:
// a heading that takes twice as long as the rotors could is not flown well either.
TEST(AttitudeReference, AYawAsksForTheTorqueThatTheRotorsHaveAndUsesHalfOfIt) {
  const double most_Nm = 4.0 * (2.2 - 0.8) * 0.0175, inertia_kgm2 = 0.0235;
  AttitudeReference reference;
  reference.start(Quaternion::Identity());
  ThrustAndAttitude wanted;
  double largest_Nm = 0.0;
  for (int i = 0; i < 300; ++i) {
    reference.step({.yaw_rate_radps = 2.0f}, true);
    reference.put(wanted);
    largest_Nm = std::max(largest_Nm,
                          inertia_kgm2 * std::abs(static_cast<double>(wanted.w_dot_B_radps2.z())));
  }
  EXPECT_LT(largest_Nm, most_Nm);
  EXPECT_GT(largest_Nm, 0.5 * most_Nm);
  EXPECT_TRUE(near(wanted.w_B_radps.z(), 2.0, stated(1e-3, "float round-off")));
}

TEST(AttitudeReference, StaysWithinItsLimits) {
  AttitudeReference reference;
  reference.start(Quaternion::Identity());
  ThrustAndAttitude wanted;
  float fastest_yaw = 0.0f;
  for (int i = 0; i < 400; ++i) {
    reference.step({.roll_rad = 3.0f, .yaw_rate_radps = 10.0f}, true);
    reference.put(wanted);
    fastest_yaw = std::max(fastest_yaw, wanted.w_B_radps.norm());
  }
  EXPECT_TRUE(near(std::acos(tilt_cosine(wanted.q_WB)), 35.0 * M_PI / 180.0,
                   stated(1e-3, "round-off of an arc cosine")));
  EXPECT_LE(fastest_yaw, 3.4f + 120.0f * kDegree);
  EXPECT_TRUE(near(wanted.w_B_radps.norm(), 120.0 * M_PI / 180.0, stated(1e-3, "float round-off")));
}

TEST(AttitudeReference, TurnsToTheHeadingThatIsAskedForAndStays) {
  AttitudeReference reference;
  reference.start(from_euler(0.0f, 0.0f, 3.0f));
  for (int i = 0; i < 1000; ++i) reference.step({.yaw_rad = -3.0f}, true);
  EXPECT_TRUE(near(wrap_pi(reference.yaw_rad() + 3.0f), 0.0, stated(0.01, "5 s of exp(-1.5 t)")));
}

TEST(RotorResponse, ReachesSetPointsAtTheRatesOfTheRotors) {
  RotorResponse rotors;
  rotors.start(2.2f);
  rotors.sent({4.2f, 2.2f, 0.8f, 2.3f});
  for (int i = 0; i < 20; ++i) rotors.step(0.001f);
  const RotorThrusts& thrusts = rotors.thrusts_N();
  EXPECT_TRUE(near(thrusts[0], 2.2 + 51.0 * 0.02, stated(1e-3, "the rate's own")));
  EXPECT_TRUE(whirl::near(thrusts[1], 2.2, whirl::stated(1e-5, "floats")));
  // T^-0.5 grows by 2.0 a second while it coasts.
  EXPECT_TRUE(near(thrusts[2], std::pow(std::pow(2.2, -0.5) + 2.0 * 0.02, -2.0),
                   stated(0.005, "steps of a millisecond")));
  EXPECT_TRUE(whirl::near(thrusts[3], 2.3, whirl::stated(1e-5, "floats")));
}

// Set-points for means: sent, and followed step by step, they have these means.
TEST(RotorResponse, SetPointsHaveTheMeansThatWereAskedFor) {
  RotorResponse rotors;
  rotors.start(3.0f);
  const ThrustRanges reach = rotors.reach();
  const RotorThrusts means{3.2f, reach[1].high_N, 2.9f, reach[3].low_N};
  rotors.sent(rotors.setpoints_for(means));
  RotorThrusts sums{};
  for (int i = 0; i < 200; ++i) {
    for (unsigned k = 0; k < 4; ++k) sums[k] += 0.5f / 200.0f * rotors.thrusts_N()[k];
    rotors.step(0.0001f);
    for (unsigned k = 0; k < 4; ++k) sums[k] += 0.5f / 200.0f * rotors.thrusts_N()[k];
  }
  for (unsigned k = 0; k < 4; ++k) {
    EXPECT_TRUE(near(sums[k], means[k], stated(0.02, "a straight fall for one that flattens")))
        << k;
  }
}

}  // namespace
}  // namespace fw

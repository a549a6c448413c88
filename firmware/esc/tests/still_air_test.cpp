// `still`: a map of still air's power that does not fit this rotor, and the second that mends it.
#include "firmware/esc/core/still_air.hpp"

#include <cmath>

#include "base/near.hpp"
#include "firmware/esc/tests/air_bench.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;
using Answer = StillAir::Answer;

// The bench's rotor takes `share` of what its ESC has been told.
Calibration told_too_much(float share) {
  Calibration c = calibrated(Mode::thrust_by_power);
  c.free_air.q2 /= share;
  c.shared_power = 0.967f;
  return c;
}

// At the bench's thrust as it stands; at most as long as the second may be looked for.
Answer ask(AirBench& bench, double thrust, StillAir& air, int* ms = nullptr) {
  air.begin();
  for (int i = 1; i <= StillAir::kLongest_ms + 10; ++i) {
    bench.hold(thrust, 1);
    if (ms != nullptr) *ms = i;
    if (const Answer answer = air.sample(bench.core); answer != Answer::measuring) {
      return answer;
    }
  }
  return Answer::measuring;
}

TEST(StillAir, FindsWhatTheRotorTakesWithinASecond) {
  for (const float share : {0.9f, 0.97f, 1.04f, 1.12f}) {
    AirBench bench(told_too_much(share));
    bench.shunt_noise_A = 0.01;
    bench.start(2.4);
    StillAir air;
    int ms = 0;
    ASSERT_EQ(ask(bench, 2.4, air, &ms), Answer::found) << share;
    EXPECT_EQ(ms, StillAir::kMean_ms);
    EXPECT_TRUE(
        near(air.share(), share, stated(0.003 * share, "shunt's noise, gaps of the bench")));
  }
}

// What is too little power for the map is a downdraft to it, in still air and in an updraft.
TEST(StillAir, TheWindIsReadRightlyAfterIt) {
  for (const bool told : {false, true}) {
    AirBench bench(told_too_much(0.94f));
    bench.start(2.4);
    EXPECT_TRUE(bench.core.estimator().observable());  // there is no wind
    if (told) {
      StillAir air;
      ASSERT_EQ(ask(bench, 2.4, air), Answer::found);
      bench.core.take_still_power(air.share());
      bench.hold(2.4, 1000);
      EXPECT_FALSE(bench.core.estimator().observable());
    }
    EXPECT_EQ(std::abs(bench.mean_thrust_N(500) - 2.4) < 0.01 * 2.4, told);
    bench.down_mps = 4.2;
    bench.hold(3.2, 2000);
    EXPECT_TRUE(bench.core.estimator().observable());
    EXPECT_EQ(std::abs(bench.mean_thrust_N(500) - 3.2) < 0.01 * 3.2, told);
  }
}

// Friction that the estimator has taken off by itself is part of the share, and not counted twice.
TEST(StillAir, WhatNoAirTakesGoesIntoTheShare) {
  AirBench bench(told_too_much(1.03f));
  bench.start(2.4);
  bench.hold(2.4, 3000);
  EXPECT_TRUE(near(bench.core.estimator().power_ratio(), 1.0, stated(0.002, "noted as excess")));
  StillAir air;
  ASSERT_EQ(ask(bench, 2.4, air), Answer::found);
  EXPECT_TRUE(near(air.share(), 1.03, stated(0.003, "gaps of the bench")));
  bench.core.take_still_power(air.share());
  bench.hold(2.4, 1000);
  EXPECT_TRUE(near(bench.core.estimator().power_ratio(), 1.0, stated(0.002, "nothing in excess")));
  ASSERT_EQ(ask(bench, 2.4, air), Answer::found);
  EXPECT_TRUE(near(air.share(), 1.0, stated(0.001, "the same rotor")));
}

TEST(StillAir, RefusesWhatNoCopyTakesAndWhereTheBalanceDoesNotHold) {
  StillAir air;
  for (const float share : {0.84f, 1.16f}) {
    AirBench bench(told_too_much(share));
    bench.start(2.4);
    EXPECT_EQ(ask(bench, 2.4, air), Answer::refused) << share;
  }
  AirBench stands(Mode::thrust_by_power);
  int ms = 0;
  EXPECT_EQ(ask(stands, 0.0, air, &ms), Answer::refused);
  EXPECT_EQ(ms, StillAir::kLongest_ms + 1);
  AirBench stopped(told_too_much(0.97f));
  stopped.start(2.4);
  stopped.hold(0.0, 1);
  EXPECT_EQ(ask(stopped, 0.0, air, &ms), Answer::refused);  // whatever was last
  Calibration slow = calibrated(Mode::thrust_by_power);
  slow.power.to_radps = 300.0f;
  AirBench beyond(slow);
  beyond.start(2.4);
  EXPECT_EQ(ask(beyond, 2.4, air), Answer::refused);
  Calibration bare = calibrated(Mode::thrust_by_power);
  bare.identified = false;
  AirBench unknown(bare);
  unknown.start(2.4);
  EXPECT_EQ(ask(unknown, 2.4, air), Answer::refused);
}

// The second begins anew with a step of thrust in it.
TEST(StillAir, AStepOfThrustIsNoCalmSecond) {
  AirBench bench(told_too_much(0.97f));
  bench.start(2.4);
  StillAir air;
  air.begin();
  int ms = 0;
  Answer answer = Answer::measuring;
  while (answer == Answer::measuring) {
    bench.hold(ms < 700 ? 2.4 : 3.2, 1);
    ++ms;
    answer = air.sample(bench.core);
  }
  EXPECT_EQ(answer, Answer::found);
  EXPECT_GT(ms, 1700);
  EXPECT_TRUE(near(air.share(), 0.97, stated(0.003, "gaps of the bench")));
}

}  // namespace
}  // namespace fw::esc

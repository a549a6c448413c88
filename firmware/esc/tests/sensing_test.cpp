#include "firmware/esc/core/sensing.hpp"

#include <cmath>
#include <numbers>

#include "base/near.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;

void rest(ZeroCurrent& zero, float reading_A, int ms) {
  for (int i = 0; i < ms; ++i) zero.record(reading_A);
}

TEST(ZeroCurrent, FindsTheOffsetAtPowerUpAndAnewAtEveryRest) {
  ZeroCurrent zero;
  rest(zero, 4.3f, 500);
  EXPECT_TRUE(near(zero.offset_A(), 4.3, stated(1e-5, "float")));
  zero.turns();
  rest(zero, 4.2f, 520);
  EXPECT_TRUE(near(zero.offset_A(), 4.2, stated(0.1 * 51 / 550, "weight of the rests before")));
  rest(zero, 4.2f, 10'000);
  EXPECT_TRUE(near(zero.offset_A(), 4.2, stated(6e-4, "float increments stall")));
}

TEST(ZeroCurrent, DoesNotTakeTheCurrentThatDiesAwayForAnOffset) {
  ZeroCurrent zero;
  rest(zero, 4.3f, 500);
  zero.turns();
  rest(zero, 9.0f, 20);
  EXPECT_TRUE(near(zero.offset_A(), 4.3, stated(1e-5, "float")));
}

// Drift of 0.4 A with 30 s, known at every rest: in closed form.
TEST(OffsetError, GrowsSinceTheLastRestAndLessWhenWarm) {
  OffsetError error(1e-3f);
  const auto run = [&](bool rests, int ms) {
    for (int i = 0; i < ms; ++i) error.tick(rests);
    return error.amperes(0.4f);
  };
  const auto drift_A = [](double at_s, double since_s) {
    return 0.008 + 0.4 * std::exp(-at_s / 30.0) * (1.0 - std::exp(-since_s / 30.0));
  };
  EXPECT_TRUE(near(run(true, 2000), 0.008, stated(1e-6, "float")));
  EXPECT_TRUE(near(run(false, 3000), drift_A(5.0, 3.0), stated(1e-4, "steps of 1 ms")));
  EXPECT_TRUE(near(run(false, 15'000), drift_A(20.0, 18.0), stated(1e-3, "float increments")));
  EXPECT_TRUE(near(run(true, 1), 0.008, stated(1e-6, "known anew")));
  EXPECT_TRUE(near(run(true, 250'000), 0.008, stated(1e-6, "float")));
  EXPECT_TRUE(near(run(false, 60'000), 0.008, stated(1e-6, "settled")));
  EXPECT_TRUE(near(error.amperes(0.0f), 0.008, stated(1e-6, "told that it is warm")));
}

// What is to come of 0.4 A falls below 15 mA after 30 s ln(0.4 / 0.015) = 98.5 s, at rest or not: the thesis's 100 s.
TEST(OffsetError, OfTheDriftLittleIsToComeAfterAHundredSeconds) {
  for (const bool rests : {false, true}) {
    OffsetError error(1e-3f);
    EXPECT_TRUE(error.settled(0.0f));
    int ms = 0;
    for (; ms < 200'000 && !error.settled(0.4f); ++ms) error.tick(rests);
    EXPECT_TRUE(near(1e-3 * ms, 98.5, stated(1.0, "float increments"))) << rests;
  }
}

// Amplifier in closed form: pulses of 10 A for a share d of 50 us behind a pole of 1 kHz, in the steady
// state, at their end.
TEST(Sensing, RippleOfTheAmplifierIsTakenOut) {
  const double x = 2.0 * std::numbers::pi * 1000.0 * 50e-6;
  for (const double d : {0.05, 0.2, 0.35, 0.6, 1.0}) {
    const double end_A = 10.0 * (1.0 - std::exp(-d * x)) / (1.0 - std::exp(-x));
    EXPECT_TRUE(near(without_ripple(static_cast<float>(end_A), static_cast<float>(d)), 10.0 * d,
                     stated(0.002 * 10.0 * d, "its series")))
        << d;
  }
}

TEST(SmoothSpeed, HalvesEveryStepAndDropsWithoutSynchronism) {
  SmoothSpeed speed;
  EXPECT_EQ(speed.update(200.0f, true), 200.0f);  // nothing before it
  EXPECT_EQ(speed.update(400.0f, true), 300.0f);
  EXPECT_EQ(speed.update(400.0f, false), 0.0f);
}

}  // namespace
}  // namespace fw::esc

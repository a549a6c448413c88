#include "firmware/esc/core/sensing.hpp"

#include <cmath>
#include <numbers>

#include "harness/base/near.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;

void rest(ZeroCurrent& zero, float reading_A, int ms) {
  for (int i = 0; i < ms; ++i) zero.note(reading_A);
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

// Oracle: seven pole pairs cross 42 times in a revolution of the shaft; ticks are 0.5 us.
#include "harness/flight/zero_crossings.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"
#include "base/rpm.hpp"
#include "harness/flight/tests/milliseconds.hpp"

namespace whirl::flight {
namespace {

struct Shaft {
  ZeroCrossings crossings{7};
  std::int64_t t_ns = 0;
  double speed_radps = 0.0;

  double rpm() const { return rpm_of(crossings.radps(crossings.pace().revolution, 6)); }
  void run(int ms, double to_radps) {
    const double from = speed_radps;
    for (int i = 1; i <= ms; ++i) {
      const double next = from + (to_radps - from) * i / ms;
      crossings.turn(t_ns, t_ns + kMs, speed_radps, next);
      speed_radps = next, t_ns += kMs;
    }
  }
};

TEST(ZeroCrossings, ASteadySpeedIsTimedToOneTick) {
  for (const double rpm : {600.0, 1000.0, 3950.0, 6000.0, 9973.0}) {
    Shaft shaft;
    shaft.speed_radps = radps_of(rpm);
    shaft.run(100, radps_of(rpm));
    // An electrical revolution lasts 60/(7 n) seconds: one tick of it is the resolution.
    const double tick = rpm * rpm * 7.0 / 60.0 * 0.5e-6;
    EXPECT_TRUE(near(shaft.rpm(), rpm, stated(tick, "one tick"))) << rpm;
  }
}

TEST(ZeroCrossings, FollowsFromTheSeventhCrossingOn) {
  Shaft shaft;
  shaft.speed_radps = radps_of(238.0);  // one crossing in 6.003 ms
  shaft.run(42, shaft.speed_radps);
  EXPECT_FALSE(shaft.crossings.in_sync());
  EXPECT_EQ(shaft.rpm(), 0.0);
  shaft.run(1, shaft.speed_radps);
  EXPECT_TRUE(shaft.crossings.in_sync());
}

TEST(ZeroCrossings, LagsARampByHalfARevolutionAtLeast) {
  Shaft shaft;
  shaft.speed_radps = radps_of(3000.0);
  shaft.run(100, shaft.speed_radps);
  shaft.run(40, radps_of(5000.0));  // 50 RPM in each millisecond
  // At 4950 RPM an electrical revolution lasts 1.73 ms: its mean is half of it old, its last
  // crossing up to a sixth more.
  const double behind_rpm = 5000.0 - shaft.rpm();
  EXPECT_GE(behind_rpm, 0.5 * 1.70 * 50.0);
  EXPECT_LE(behind_rpm, (0.5 + 1.0 / 6.0) * 1.76 * 50.0);
}

TEST(ZeroCrossings, TheLatestSectorLagsLessAndSaysWhetherItSlows) {
  Shaft shaft;
  shaft.speed_radps = radps_of(3000.0);
  shaft.run(100, shaft.speed_radps);
  EXPECT_FALSE(shaft.crossings.pace().slowing);
  shaft.run(40, radps_of(5000.0));
  const double latest = rpm_of(shaft.crossings.radps(shaft.crossings.pace().sector, 1));
  EXPECT_GT(latest, shaft.rpm() + 20.0);
  EXPECT_LT(latest, 5000.0);
  EXPECT_FALSE(shaft.crossings.pace().slowing);
  shaft.run(40, radps_of(2000.0));
  EXPECT_TRUE(shaft.crossings.pace().slowing);
}

TEST(ZeroCrossings, LosesARotorThatStopsAndFindsItAgain) {
  Shaft shaft;
  shaft.speed_radps = radps_of(4000.0);
  shaft.run(50, shaft.speed_radps);
  ASSERT_TRUE(shaft.crossings.in_sync());
  shaft.speed_radps = 0.0;
  shaft.run(3, 0.0);  // nine sectors of 0.357 ms last 3.2 ms
  EXPECT_TRUE(shaft.crossings.in_sync());
  shaft.run(1, 0.0);
  EXPECT_FALSE(shaft.crossings.in_sync());
  shaft.run(50, radps_of(1000.0));
  EXPECT_TRUE(shaft.crossings.in_sync());
  shaft.crossings.restart();
  EXPECT_FALSE(shaft.crossings.in_sync());
}

}  // namespace
}  // namespace whirl::flight

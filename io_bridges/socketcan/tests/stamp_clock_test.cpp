#include "io_bridges/socketcan/stamp_clock.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace whirl::io {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// A controller whose clock is off by an hour and drifts by 50 ppm; the kernel sees frames 20 us to 3 ms later.
TEST(StampClock, LeavesOfTheDelayOnlyTheLeastAndTheDrift) {
  StampClock clock;
  RandomStream random(1, "delay");
  std::int64_t worst_ns = 0;
  for (std::int64_t n = 0; n < 60'000; ++n) {
    const std::int64_t true_ns = n * kMs;
    const std::int64_t stamp_ns = 3'600'000 * kMs + true_ns + true_ns / 20'000;
    const auto delay_ns = static_cast<std::int64_t>(20'000 + 2'980'000 * random.uniform());
    const std::int64_t told_ns = clock.host_ns(stamp_ns, true_ns + delay_ns);
    EXPECT_LE(told_ns, true_ns + delay_ns);  // never after it was seen
    if (n > 1000) worst_ns = std::max(worst_ns, std::abs(told_ns - true_ns));
  }
  // 20 us of delay that nothing shows, at most a second's worth of rare luck, 20 s of drift.
  EXPECT_LE(worst_ns, 1'100'000);
}

TEST(StampClock, AControllerThatWasResetStartsAnew) {
  StampClock clock;
  EXPECT_EQ(clock.host_ns(500'000 * kMs, 10 * kMs), 10 * kMs);
  EXPECT_EQ(clock.host_ns(1 * kMs, 20 * kMs), 20 * kMs);
  EXPECT_EQ(clock.host_ns(2 * kMs, 23 * kMs), 21 * kMs);
}

}  // namespace
}  // namespace whirl::io

// Samples of a host that come unevenly: when they are shown, how much later that is, and which are told to be late.
#include "firmware/pod/sample_clock.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <vector>

#include "base/near.hpp"
#include "base/random.hpp"

namespace fw::pod {
namespace {

constexpr int kPeriod_us = 993;  // the part's own clock is 0.7 % fast
constexpr int kFastest_us = 74;  // of a sample's way

struct Shown {
  double after_us = 0.0;  // of its stamp and the fastest way, by the pod's clock
  std::int64_t at_us = 0;
  bool late = false;
};

// way_us: of sample k, beyond the fastest. The pod's clock runs off by drift_ppm, both wrap soon.
std::vector<Shown> play(int samples, const std::function<double(int)>& way_us,
                        double drift_ppm = 50.0) {
  SampleClock clock;
  std::vector<Shown> all;
  std::int64_t came_us = 0;
  constexpr std::int64_t kOffset_us = 0xFFFF'0000;
  for (int k = 0; k < samples; ++k) {
    const std::int64_t stamp_us = 60'000 + std::int64_t{k} * kPeriod_us;
    const double at_us = static_cast<double>(stamp_us) * (1.0 + drift_ppm * 1e-6);
    came_us = std::max(came_us, static_cast<std::int64_t>(at_us + kFastest_us + way_us(k)));
    const auto now_us = static_cast<std::uint32_t>(came_us + kOffset_us);
    const auto place = clock.place(static_cast<std::uint16_t>(stamp_us), now_us);
    const auto left_us = static_cast<std::int32_t>(place.due_us - now_us);
    const std::int64_t shown_us = came_us + std::max(left_us, 0);
    all.push_back({static_cast<double>(shown_us) - at_us - kFastest_us, shown_us, place.late});
  }
  return all;
}

struct Judged {
  int late = 0;
  std::int64_t least_period_us = 1 << 20, most_period_us = 0;
  double longest_us = 0.0;
};
Judged judge(const std::vector<Shown>& all, std::size_t from) {
  Judged judged;
  for (std::size_t k = from; k < all.size(); ++k) {
    const std::int64_t period_us = all[k].at_us - all[k - 1].at_us;
    judged.late += all[k].late ? 1 : 0;
    judged.least_period_us = std::min(judged.least_period_us, period_us);
    judged.most_period_us = std::max(judged.most_period_us, period_us);
    judged.longest_us = std::max(judged.longest_us, all[k].after_us);
  }
  return judged;
}

std::function<double(int)> random_way(double most_us) {
  auto chance = std::make_shared<whirl::RandomStream>(7, "way");
  return [chance, most_us](int) { return most_us * chance->uniform(); };
}

TEST(SampleClock, ShowsEvenlyWhatComesUnevenly) {
  for (const double drift_ppm : {-60.0, 0.0, 60.0}) {
    const Judged judged = judge(play(30'000, random_way(1000.0), drift_ppm), 5000);
    EXPECT_EQ(judged.late, 0);
    EXPECT_GE(judged.least_period_us, kPeriod_us - 2);
    EXPECT_LE(judged.most_period_us, kPeriod_us + 5);
    // Its own spread, the guard, and what the drift makes of a second.
    EXPECT_LT(judged.longest_us, 1000 + 100 + 150);
  }
}

// An adapter that gathers for a millisecond: two samples of one packet, none in another.
TEST(SampleClock, ShowsEvenlyWhatComesInPacketsOfAMillisecond) {
  const auto way_us = [](int k) {
    const int phase_us = (60'000 + k * kPeriod_us + kFastest_us) % 1000;
    return phase_us == 0 ? 0.0 : 1000.0 - phase_us;
  };
  const Judged judged = judge(play(20'000, way_us, 0.0), 3000);
  EXPECT_EQ(judged.late, 0);
  EXPECT_GE(judged.least_period_us, kPeriod_us - 2);
  EXPECT_LE(judged.most_period_us, kPeriod_us + 5);
  EXPECT_LT(judged.longest_us, 1000 + 250);
}

TEST(SampleClock, AddsLittleToAHostThatIsEven) {
  const Judged judged = judge(play(20'000, random_way(20.0)), 3000);
  EXPECT_EQ(judged.late, 0);
  EXPECT_LT(judged.longest_us, 20 + 100 + 60);
}

TEST(SampleClock, ASampleThatIsLateIsShownAtOnceAndTold) {
  const auto way_us = [](int k) { return k == 6000 ? 800.0 : 0.0; };
  const auto all = play(20'000, way_us, 0.0);
  for (std::size_t k = 3000; k < all.size(); ++k) EXPECT_EQ(all[k].late, k == 6000) << k;
  EXPECT_TRUE(whirl::near(all[6000].after_us, 800.0, whirl::stated(2.0, "us: what clocks show")));
  EXPECT_LT(all[6001].after_us, 250.0);  // the clock goes on as it was, but for 4 us
  for (std::size_t k = 6002; k < all.size(); ++k) {
    const std::int64_t period_us = all[k].at_us - all[k - 1].at_us;
    EXPECT_TRUE(whirl::near(period_us, kPeriod_us, whirl::stated(5, "us: how fast it moves"))) << k;
  }
  EXPECT_GT(all[6300].after_us, 800.0);    // ready for another one
  EXPECT_LT(all[19'000].after_us, 200.0);  // and forgotten
}

// Each fiftieth sample, and those that wait behind it, come up to 5 ms late.
TEST(SampleClock, TheDelayIsBoundedAndWhatIsLaterIsTold) {
  const auto all = play(
      30'000, [](int k) { return k % 50 == 0 ? 5000.0 : 0.0; }, 0.0);
  const Judged judged = judge(all, 5000);
  EXPECT_GT(judged.late, 25'000 / 50);
  EXPECT_LT(judged.late, 25'000 / 50 * 4);
  for (std::size_t k = 5000; k < all.size(); ++k) {
    const double bound_us = all[k].late ? 5000.0 + 20.0 : 3000.0 + 20.0;
    EXPECT_LE(all[k].after_us, bound_us) << k;
  }
}

// Its virtual time stood for 15 ms: from then on all its stamps are so much behind.
TEST(SampleClock, AHostThatStoodIsFollowedSoon) {
  const auto all = play(
      10'000, [](int k) { return k < 6000 ? 0.0 : 15'000.0; }, 0.0);
  EXPECT_TRUE(all[6000].late);
  const Judged judged = judge(all, 6000 + 2 * 50);
  EXPECT_EQ(judged.late, 0);
  EXPECT_LT(judged.longest_us, 15'000.0 + 3000.0);
}

TEST(SampleClock, BeginsAnewAfterAPause) {
  SampleClock clock;
  EXPECT_FALSE(clock.place(500, 10'000).late);
  EXPECT_EQ(clock.place(1500, 11'000).due_us, 11'100u);
  const auto anew = clock.place(9000, 5'000'000);
  EXPECT_TRUE(anew.late);
  EXPECT_EQ(anew.due_us, 5'000'100u);
  EXPECT_EQ(clock.place(10'000, 5'001'000).due_us, 5'001'100u);
}

}  // namespace
}  // namespace fw::pod

#include "firmware/esc/core/middles.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "base/random.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;

constexpr int kBus = 2640;

// A resting rotor whose phases read by these shares too much, with noise.
Middles probed(const std::array<double, 6>& error, double noise_counts) {
  Middles middles;
  whirl::RandomStream random(5, "probe");
  middles.begin_probe();
  bool done = false;
  for (int n = 0; n < 6 * Middles::kSamples; ++n) {
    EXPECT_FALSE(done);
    const double half = 0.5 * kBus * (1.0 + error[middles.probed_step()]);
    const auto noisy = [&](double x) {
      return static_cast<int>(std::lround(x + noise_counts * random.normal()));
    };
    const int floating = noisy(half);
    done = middles.probe(floating, noisy(kBus));
  }
  EXPECT_TRUE(done);
  return middles;
}

TEST(Middles, OnPaperTheMiddleIsHalfTheBus) {
  const Middles paper;
  for (std::uint8_t step = 0; step < 6; ++step) {
    EXPECT_EQ(paper.off(step, 1320, kBus), 0);
    EXPECT_EQ(paper.off(step, 1330, kBus), 20);
  }
}

TEST(Middles, RestShowsEachStepsOwnMiddle) {
  const std::array<double, 6> error{0.017, -0.01, 0.0, 0.008, -0.017, 0.03};
  const Middles found = probed(error, 1.5);
  for (std::uint8_t step = 0; step < 6; ++step) {
    const int at_middle = static_cast<int>(std::lround(0.5 * kBus * (1.0 + error[step])));
    // Doubled noise of 3.4 counts, averaged over 12.
    EXPECT_TRUE(near(found.off(step, at_middle, kBus), 0.0, stated(4.0, "four sigma of the mean")));
  }
}

TEST(Middles, NoiseIsFoundAtItsOwnSize) {
  EXPECT_EQ(probed({}, 0.0).noise_counts(), 0);
  const int some = probed({}, 1.5).noise_counts(), much = probed({}, 3.7).noise_counts();
  EXPECT_GT(some, 8);  // a range of 12 samples is 3.3 sigma, the widest of six some 4.5
  EXPECT_LT(some, 24);
  EXPECT_GT(much, 2 * some - 8);
}

// What no converter of this kind shows is not believed: an open wire, a rotor that still turns.
TEST(Middles, WhatIsNoDividersErrorIsBounded) {
  const Middles open = probed({-1.0, 0, 0, 0, 0, 0}, 0.0);
  EXPECT_LT(std::abs(open.off(0, kBus / 2, kBus)), kBus / 20 + 2);
}

TEST(Middles, EarlyCrossingMovesItsMiddleSoThatItComesLater) {
  for (const std::uint8_t step : {std::uint8_t{2}, std::uint8_t{3}}) {
    Middles middles;
    for (int n = 0; n < 20; ++n) middles.learn(step, 40, kBus);
    // A falling phase is later where the middle is lower, so that it still lies above it.
    const int off = middles.off(step, kBus / 2, kBus);
    EXPECT_GT((step & 1) != 0 ? -off : off, 40);
  }
}

TEST(Middles, WhatAllCrossingsShareMovesNothing) {
  Middles middles;
  for (int n = 0; n < 600; ++n) middles.learn(static_cast<std::uint8_t>(n % 6), 40, kBus);
  for (std::uint8_t step = 0; step < 6; ++step) {
    EXPECT_TRUE(near(middles.off(step, kBus / 2, kBus), 0.0, stated(8.0, "one turn's worth")));
  }
}

}  // namespace
}  // namespace fw::esc

#include "io_bridges/rack/models/sense_line.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace whirl::rack {
namespace {

constexpr io::Nanoseconds kMs = 1'000'000;

TEST(SenseLine, FollowsAStepByItsTimeConstantHoweverOftenItIsSampled) {
  SenseLine once({.time_constant_s = 825e-6}), often({.time_constant_s = 825e-6});
  for (SenseLine* line : {&once, &often}) {
    line->set_V(1.0, 0);
    line->set_V(2.0, 5 * kMs);
  }
  for (io::Nanoseconds t = 5 * kMs; t < 6 * kMs; t += 10'000) often.sample_V(t);
  const double want_V = 2.0 - std::exp(-1.0 / 0.825);
  EXPECT_TRUE(near(once.sample_V(6 * kMs), want_V, round_off(8, want_V)));
  EXPECT_TRUE(near(often.sample_V(6 * kMs), want_V, round_off(400, want_V)));
}

TEST(SenseLine, BeginsSettled) {
  SenseLine line({.time_constant_s = 10.0});
  line.set_V(1.5, 0);
  EXPECT_EQ(line.sample_V(1), 1.5);
}

TEST(SenseLine, ThePinsDiodesHoldItNearTheRails) {
  SenseLine line({.supply_V = 3.3});
  line.set_V(20.0, 0);
  EXPECT_TRUE(near(line.sample_V(1), 3.6, round_off(2, 3.6)));
  line.set_V(-5.0, 2);
  EXPECT_TRUE(near(line.sample_V(3), -0.3, round_off(2, 0.3)));
}

TEST(SenseLine, NoiseIsWhiteAndOfTheGivenSize) {
  SenseLine line({.noise_V = 0.01});
  line.set_V(1.0, 0);
  double sum = 0.0, squares = 0.0, products = 0.0, last = 0.0;
  constexpr int kSamples = 10'000;
  for (int i = 1; i <= kSamples; ++i) {
    const double noise_V = line.sample_V(i) - 1.0;
    sum += noise_V;
    squares += noise_V * noise_V;
    products += noise_V * last;
    last = noise_V;
  }
  EXPECT_TRUE(near(sum / kSamples, 0.0, stated(4e-4, "four standard errors")));
  EXPECT_TRUE(near(std::sqrt(squares / kSamples), 0.01, stated(3e-4, "four standard errors")));
  EXPECT_TRUE(near(products / squares, 0.0, stated(0.04, "four standard errors")));
}

TEST(SenseLine, ResistorsAreDrawnEvenlyWithinTheirTolerance) {
  double least = 2e4, most = 0.0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const double ohm = drawn_resistance_ohm(10e3, 0.01, seed, "r");
    least = std::min(least, ohm);
    most = std::max(most, ohm);
  }
  EXPECT_GE(least, 9900.0);
  EXPECT_LE(most, 10100.0);
  EXPECT_LT(least, 9905.0);
  EXPECT_GT(most, 10095.0);
}

}  // namespace
}  // namespace whirl::rack

// The image's square root against the host's.
#include "firmware/esc/core/square_root.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/near.hpp"

namespace fw::esc {
namespace {

void expect_within_an_ulp(float x) {
  const double exact = std::sqrt(static_cast<double>(x));
  const double ulp = std::ldexp(1.0, std::ilogb(exact) - 23);
  EXPECT_TRUE(whirl::near(square_root(x), exact, whirl::stated(ulp, "one ulp of a float"))) << x;
}

TEST(SquareRoot, IsWithinAnUlpForEveryNormalNumber) {
  std::mt19937 random(3);
  for (int i = 0; i < 2'000'000; ++i) {
    const float x = std::bit_cast<float>(static_cast<std::uint32_t>(random()) & 0x7FFFFFFFu);
    if (std::isnormal(x)) expect_within_an_ulp(x);
  }
  for (const float x : {1.0f, 2.0f, 4.0f, 9.0f, 1.9999999f, 3.9999998f, 0.99999994f, 0.25f,
                        std::numeric_limits<float>::min(), std::numeric_limits<float>::max()}) {
    expect_within_an_ulp(x);
  }
}

TEST(SquareRoot, OfNothingIsNothing) {
  EXPECT_EQ(square_root(0.0f), 0.0f);
  EXPECT_EQ(square_root(-1.0f), 0.0f);
}

}  // namespace
}  // namespace fw::esc

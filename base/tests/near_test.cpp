#include "base/near.hpp"

#include <limits>

namespace whirl {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Near, FailsOnBothSidesAndPassesOnTheEdge) {
  EXPECT_TRUE(near(1.5, 1.0, stated(0.5, "edge")));
  EXPECT_FALSE(near(1.6, 1.0, stated(0.5, "above")));
  EXPECT_FALSE(near(0.4, 1.0, stated(0.5, "below")));
}

TEST(Near, NotANumberNeverPasses) {
  EXPECT_FALSE(near(kNaN, 1.0, stated(1e9, "got")));
  EXPECT_FALSE(near(1.0, kNaN, stated(1e9, "want")));
  EXPECT_FALSE(near(1.0, 1.0, stated(kNaN, "limit")));
}

}  // namespace
}  // namespace whirl

#include "base/rpm.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"

namespace whirl {
namespace {

TEST(Rpm, OneTurnASecondIsSixtyRpm) {
  EXPECT_TRUE(near(rpm_of(2.0 * std::numbers::pi), 60.0, round_off(4, 60.0)));
  EXPECT_TRUE(near(radps_of(60.0), 2.0 * std::numbers::pi, round_off(4, 7.0)));
}

// 950 rpm/V is 99.48 rad/s for each volt, and one over that in N m/A.
TEST(Rpm, KvOfTheDataSheetGivesTheTorqueConstant) {
  EXPECT_TRUE(near(torque_constant_NmpA_of(950.0), 0.01005, printed_to(1e-5)));
}

}  // namespace
}  // namespace whirl

#include "io_bridges/link/spin_policy.hpp"

#include <gtest/gtest.h>

namespace whirl::io {
namespace {

TEST(SpinPolicy, LooksLongerAndLongerWhereNobodyElseWantsTheCore) {
  SpinPolicy policy(2);
  EXPECT_EQ(policy.turns(), SpinPolicy::kLeast);
  policy.waited(0);
  EXPECT_EQ(policy.turns(), 2 * SpinPolicy::kLeast);
  for (int i = 0; i < 20; ++i) policy.waited(0);
  EXPECT_EQ(policy.turns(), SpinPolicy::kMost);
}

TEST(SpinPolicy, GivesWayAtOnceAndForAWhileWhereItWasInTheWay) {
  SpinPolicy policy(2);
  for (int i = 0; i < 20; ++i) policy.waited(5);  // what came before it counts once
  policy.waited(6);
  EXPECT_EQ(policy.turns(), SpinPolicy::kLeast);
  for (int i = 0; i < SpinPolicy::kHeld_back; ++i) policy.waited(6);
  EXPECT_EQ(policy.turns(), SpinPolicy::kLeast);
  policy.waited(6);
  EXPECT_EQ(policy.turns(), 2 * SpinPolicy::kLeast);
}

TEST(SpinPolicy, DoesNotLookAtAllOnTheOnlyCore) {
  SpinPolicy policy(1);
  for (int i = 0; i < 20; ++i) policy.waited(0);
  EXPECT_EQ(policy.turns(), 0);
}

}  // namespace
}  // namespace whirl::io

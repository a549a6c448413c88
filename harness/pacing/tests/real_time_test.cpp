#include "harness/pacing/real_time.hpp"

#include <gtest/gtest.h>
#include <sched.h>

namespace whirl::pacing {
namespace {

TEST(RealTime, TellsWhatTheKernelSaysOfTheThread) {
  const RealTime got = take_real_time();
  const int policy = sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
  EXPECT_EQ(got.first_in_line, policy == SCHED_FIFO) << got.told;
  EXPECT_EQ(got.first_in_line, got.told.starts_with("SCHED_FIFO")) << got.told;
  give_back_real_time();
  EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
}

}  // namespace
}  // namespace whirl::pacing

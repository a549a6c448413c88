#include "base/outside_signal.hpp"

#include <gtest/gtest.h>

namespace whirl {
namespace {

TEST(OutsideSignal, AreThoseThatNoBugOfAProgramRaises) {
  for (int signal :
       {SIGKILL, SIGTERM, SIGINT, SIGQUIT, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ, SIGBUS}) {
    EXPECT_TRUE(is_from_outside(signal)) << signal;
  }
  for (int signal : {SIGSEGV, SIGABRT, SIGILL, SIGFPE, SIGTRAP, SIGSYS, SIGPIPE, SIGALRM, 0}) {
    EXPECT_FALSE(is_from_outside(signal)) << signal;
  }
}

}  // namespace
}  // namespace whirl

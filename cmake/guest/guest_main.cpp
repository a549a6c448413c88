// The main of a test of label guest: outside the guest it fails at once, and says how it is run.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (access("/run/whirl_guest/report/started", F_OK) != 0) {
    std::fprintf(stderr, "this test runs inside the guest only: ./whirl test --guest\n");
    return 1;
  }
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}

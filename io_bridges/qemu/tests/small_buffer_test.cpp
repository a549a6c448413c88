// What QEMU has no room for it translates again: that moves nothing in the guest.
#include <gtest/gtest.h>

#include "io_bridges/qemu/tests/board_run.hpp"
#include "io_bridges/qemu/tests/qemu_with.hpp"

namespace whirl::board_test {
namespace {

// The image reaches a register in each of 600 pieces, and each time QEMU has that instruction done again
// by itself: where its buffer is full just then, it forgets that it was to be one instruction.
TEST(SmallBuffer, RoundsThroughMuchCodeTakeTheSameCycles) {
  BoardSetup setup{image("much_code"), {}};
  setup.mcu = "stm32f405rg";
  setup.more =
      R"("ns_per_instruction":0,"devices":[{"name":"terminal","type":"serial","baud":115200,"bus":"usart2"}])";
  const auto in_large = run_for(setup, 60).numbers();
  ASSERT_EQ(in_large.size(), 12u);
  const QemuWith small(kSmall_buffer);
  EXPECT_EQ(run_for(setup, 60).numbers(), in_large);
}

}  // namespace
}  // namespace whirl::board_test

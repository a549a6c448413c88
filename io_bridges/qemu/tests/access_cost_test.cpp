// What a load costs by where it reads. Expected by hand: the wait states of FLASH_ACR, and a cache of
// 8 lines of 16 bytes on the STM32F405 (RM0090 3.4.2); the same loops over RAM take the rest off.
#include <gtest/gtest.h>

#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

using Counts = std::vector<std::uint32_t>;

Counts told(const std::string& name, const std::string& mcu) {
  BoardSetup setup{image(name), {}};
  setup.mcu = mcu;
  setup.more =
      R"("ns_per_instruction":0,"devices":[{"name":"terminal","type":"serial","baud":115200,)"
      R"("bus":")" +
      std::string(mcu == "stm32f405rg" ? "usart2" : "usart1") + R"("}])";
  return run_for(setup, 100).told();
}

constexpr std::size_t kWalks = 6;
constexpr double kReads = 1000;

// `counts` has the walks over RAM, then those over flash. Fetches at a loop's ends take a little more or less.
void expect_waits(const Counts& counts, std::size_t from, const double (&expected)[kWalks],
                  const std::string& what) {
  ASSERT_GE(counts.size(), from + 2 * kWalks) << what;
  for (std::size_t n = 0; n < kWalks; ++n) {
    const double waits = static_cast<double>(counts[from + kWalks + n]) - counts[from + n];
    EXPECT_NEAR(waits, expected[n], 25) << what << ", walk " << n;
  }
}

TEST(AccessCost, DataFromFlashWaitsUnlessACacheHoldsIt) {
  const Counts f4 = told("tables_f4", "stm32f405rg"), f1 = told("tables_f1", "stm32f103cb");
  constexpr double kW4 = 5, kW1 = 2, kLine = 4;  // words to a line
  // The same word, word by word, a line each; 8 lines stay, 10 push each other out; four words at once.
  expect_waits(
      f4, 0, {kW4, kReads / kLine * kW4, kReads * kW4, 8 * kW4, kReads * kW4, kReads / kLine * kW4},
      "cached");
  expect_waits(f4, 2 * kWalks,
               {kReads * kW4, kReads * kW4, kReads * kW4, kReads * kW4, kReads * kW4, kReads * kW4},
               "uncached");
  expect_waits(f1, 0,
               {kReads * kW1, kReads * kW1, kReads * kW1, kReads * kW1, kReads * kW1, kReads * kW1},
               "F103");
}

}  // namespace
}  // namespace whirl::board_test

// What a load costs by where it reads. Expected by hand: the wait states of FLASH_ACR, and a cache of
// 8 lines of 16 bytes on the STM32F405 (RM0090 3.4.2); the same loops over RAM take the rest off.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

using Counts = std::vector<std::uint32_t>;

Counts counts_of(const std::string& name, const std::string& mcu) {
  BoardSetup setup{image(name), {}};
  setup.mcu = mcu;
  setup.more =
      R"("ns_per_instruction":0,"devices":[{"name":"terminal","type":"serial","baud":115200,)"
      R"("bus":")" +
      std::string(mcu == "stm32f405rg" ? "usart2" : "usart1") + R"("}])";
  return run_for(setup, 100).numbers();
}

constexpr std::size_t kWalks = 6;
constexpr double kReads = 1000;

// `counts` has the walks over RAM, then those over flash. Fetches at a loop's ends take a little more or less.
void expect_waits(const Counts& counts, std::size_t from, const double (&expected)[kWalks],
                  const std::string& what) {
  ASSERT_GE(counts.size(), from + 2 * kWalks) << what;
  for (std::size_t n = 0; n < kWalks; ++n) {
    const double waits = static_cast<double>(counts[from + kWalks + n]) - counts[from + n];
    EXPECT_TRUE(near(waits, expected[n], stated(25, "fetches at a loop's ends")))
        << what << ", walk " << n;
  }
}

TEST(AccessCost, DataFromFlashWaitsUnlessACacheHoldsIt) {
  const Counts f4 = counts_of("tables_f4", "stm32f405rg"),
               f1 = counts_of("tables_f1", "stm32f103cb");
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

// DDI 0337 and 0439: a half-word goes as two bytes, a word as two half-words or as a byte, a half-word and a
// byte, each transfer a cycle.
TEST(AccessCost, WhatIsNotAlignedTakesACycleForEachTransferMore) {
  for (const auto& [name, mcu] :
       {std::pair{"operands_f4", "stm32f405rg"}, std::pair{"operands_f1", "stm32f103cb"}}) {
    const Counts counts = counts_of(name, mcu);
    ASSERT_GE(counts.size(), 18u) << mcu;
    // LDR, STR, LDRH, LDRSH, STRH, LDRB at 1, 2 and 3 bytes behind a word.
    const Counts expected = {200, 200, 100, 100, 100, 0,   100, 100, 0,
                             0,   0,   0,   200, 200, 100, 100, 100, 0};
    for (std::size_t n = 0; n < expected.size(); ++n) {
      EXPECT_TRUE(near(counts[n], expected[n], stated(1, "where a block is cut")))
          << mcu << ", access " << n;
    }
  }
}

// DDI 0337G 12.10. A transfer over the bridge takes two PCLK and one HCLK here, three cycles in all. A store leaves the core
// at once (a cycle); a load takes two and waits. Two writes by alias: the second waits until the bridge has
// read and written for the first, six cycles; a turn of the loop less saves some four.
TEST(AccessCost, AWriteByABitBandAliasHoldsTheBridgeForTwoTransfersAndNotTheCore) {
  for (const auto& [name, mcu] :
       {std::pair{"aliases_f4", "stm32f405rg"}, std::pair{"aliases_f1", "stm32f103cb"}}) {
    const Counts counts = counts_of(name, mcu);
    ASSERT_EQ(counts.size(), 6u) << mcu;
    EXPECT_TRUE(near(counts[0], 100, stated(10, "fetches at a loop's ends"))) << mcu;
    EXPECT_TRUE(near(counts[1], 100, stated(10, "fetches at a loop's ends"))) << mcu;
    EXPECT_TRUE(near(counts[2], 500, stated(110, "a cycle of each write"))) << mcu;
    EXPECT_TRUE(near(counts[3], counts[2], stated(5, "fetches at a loop's ends"))) << mcu;
    EXPECT_TRUE(
        near(static_cast<int>(counts[4]), 100 * (1 + 6 - 4), stated(110, "a cycle of each write")))
        << mcu;
    EXPECT_EQ(counts[5], 5u | 7u << 3) << mcu;
  }
}

// RM0090 2.1: the bus matrix lets masters take turns; here none of DMA's transfers holds up the core.
TEST(AccessCost, TheCoreDoesNotPayForWhatDmaAccesses) {
  const Counts counts = counts_of("dma_wait", "stm32f405rg");
  ASSERT_EQ(counts.size(), 8u);
  for (const std::size_t n : {2u, 4u, 6u}) {
    EXPECT_TRUE(near(counts[n], counts[0], stated(12, "where deadlines cut the loop"))) << n;
    EXPECT_LT(counts[n + 1], 19000u) << n;
    EXPECT_GT(counts[n + 1], 0u) << n;
  }
}

// DDI 0337: UMULL, SMULL 3 to 5, UMLAL, SMLAL 4 to 7, the signed one a cycle longer, by the size of the
// operands; DDI 0439: always 1.
TEST(OperandCost, LongMultipliesOfAnM3GoByTheSizeOfTheirOperands) {
  const Counts f4 = counts_of("operands_f4", "stm32f405rg"),
               f1 = counts_of("operands_f1", "stm32f103cb");
  ASSERT_EQ(f4.size(), 25u);
  ASSERT_EQ(f1.size(), 25u);
  const Counts expected = {100, 200, 0, 200, 100, 200};
  for (std::size_t n = 0; n < expected.size(); ++n) {
    EXPECT_TRUE(near(f1[18 + n], expected[n], stated(3, "and where a block is cut")))
        << n;  // and where a block is cut
    EXPECT_TRUE(near(f4[18 + n], 0, stated(1, "where a block is cut"))) << n;
  }
}

TEST(OperandCost, WhatIsCountedTouchesNoResult) {
  for (const Counts& counts :
       {counts_of("operands_f4", "stm32f405rg"), counts_of("operands_f1", "stm32f103cb")}) {
    ASSERT_EQ(counts.size(), 25u);
    EXPECT_EQ(counts.back(), 0u);
  }
}

}  // namespace
}  // namespace whirl::board_test

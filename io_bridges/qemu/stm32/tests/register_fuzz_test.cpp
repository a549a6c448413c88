// Some of the programs that `whirl fuzz` runs by the hundred thousand. WHIRL_FUZZ_SEEDS: more.
#include "io_bridges/qemu/stm32/fuzz/register_fuzz.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace whirl::stm32 {
namespace {

std::uint64_t seeds() {
  const char* wanted = std::getenv("WHIRL_FUZZ_SEEDS");
  return wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 2000;
}

TEST(RegisterFuzz, EveryProgramEndsWithBoundedEvents) {
  std::uint64_t accesses = 0;
  for (std::uint64_t seed = 0; seed < seeds(); ++seed) {
    const FuzzOutcome outcome = fuzz_registers(seed);
    EXPECT_EQ(outcome.complaint, "") << "seed " << seed;
    accesses += outcome.accesses;
  }
  EXPECT_GT(accesses, seeds() * 100);  // they do something
}

TEST(RegisterFuzz, ASeedIsAProgramAndATrace) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(fuzz_registers(seed).trace, fuzz_registers(seed).trace) << seed;
    EXPECT_NE(fuzz_registers(seed).trace, fuzz_registers(seed + 20).trace) << seed;
  }
}

}  // namespace
}  // namespace whirl::stm32

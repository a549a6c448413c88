// Clocks that speak up: start-up code as vendors ship it, and what is said when it gives up.
#include <gtest/gtest.h>

#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

struct Start {
  const char* image;
  const char* mcu;
  double sysclk_Hz;
};
constexpr Start kStarts[] = {{"st_start_f4_o0", "stm32f405rg", 168e6},
                             {"st_start_f4_o2", "stm32f405rg", 168e6},
                             {"st_start_f1_o0", "stm32f103cb", 72e6},
                             {"st_start_f1_o2", "stm32f103cb", 72e6}};

enum class Timing { fixed, cycles };

BoardRun run_start(const Start& start, Timing timing, const std::string& more, int milliseconds) {
  BoardSetup setup{image(start.image), {}};
  setup.mcu = start.mcu;
  const bool f4 = setup.mcu == "stm32f405rg";
  const std::string fixed = f4 ? "8" : "16";
  setup.more = R"("ns_per_instruction":)" + (timing == Timing::fixed ? fixed : "0") + more;
  return run_for(setup, milliseconds);
}

double last_sysclk_Hz(const BoardRun& run) {
  const auto clocks = run.of(io::Kind::clock_setup);
  return clocks.empty() ? 0.0 : clocks.back()->as<io::ClockSetup>().sysclk_Hz;
}

TEST(Clocks, TheCountedLoopOfStsStartUpReachesACrystalOfTwoMilliseconds) {
  for (const Start& start : kStarts) {
    const BoardRun run = run_start(start, Timing::cycles, R"(,"hse_start_ns":2000000)", 10);
    EXPECT_EQ(last_sysclk_Hz(run), start.sysclk_Hz) << start.image << run.error.message();
    EXPECT_FALSE(run.found("given up")) << start.image;
  }
}

TEST(Clocks, ACrystalThatIsGivenUpIsSaidAtOnce) {
  for (const Start& start : kStarts) {
    const BoardRun run = run_start(start, Timing::cycles, R"(,"hse_start_ns":100000000)", 120);
    EXPECT_LT(last_sysclk_Hz(run), 17e6) << start.image;
    EXPECT_TRUE(run.found("the crystal was given up")) << start.image;
  }
}

TEST(Clocks, ACoreThatStaysOnItsResetClockAndItsProfileAreSaidAfterATenthOfASecond) {
  for (const Start& start : kStarts) {
    const BoardRun run = run_start(start, Timing::fixed, R"(,"hse_start_ns":900000000)", 120);
    EXPECT_TRUE(run.found("still runs from its reset clock")) << start.image;
    EXPECT_TRUE(run.found("does not fit the timing profile")) << start.image;
    for (const Message* finding : run.of(io::Kind::finding)) {
      EXPECT_LT(finding->head.t_ns, 110'000'000) << run.text_of(*finding);  // not at the end
    }
  }
}

}  // namespace
}  // namespace whirl::board_test

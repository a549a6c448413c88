// Start-ups in the manner of several libraries, and their delays, on both parts: what the stand's own
// clock says of them. Expected by hand, from the data sheets' start-up times (HSE 2 ms, PLL 200 us) and
// ARM's tables (DDI 0337 and 0439: SUBS 1, LDR 2, CMP 1, B taken 1 + P, P of 1 to 3).
#include <gtest/gtest.h>

#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

struct FullClock {
  const char *letter, *mcu;
  double sysclk_Hz, reset_Hz;
  int wait_states;
  bool line_cache;
};
constexpr FullClock kParts[] = {{"_f4", "stm32f405rg", 168e6, 16e6, 5, true},
                                {"_f1", "stm32f103cb", 72e6, 8e6, 2, false}};
const std::vector<std::string> kMarks = {"mark_ready",       "mark_loop_end", "mark_dwt_end",
                                         "mark_systick_end", "mark_tick_end", "mark_given_up"};
enum Mark : std::size_t { ready, loop_end, dwt_end, systick_end, tick_end, given_up };

struct Start {
  BoardRun run;
  std::vector<double> reached_ns;  // of each mark; -1: not reached
  double took_ns(Mark mark) const { return reached_ns[mark] - reached_ns[mark - 1]; }
  double sysclk_Hz() const {
    const auto clocks = run.of(io::Kind::clock_setup);
    return clocks.empty() ? 0.0 : clocks.back()->as<io::ClockSetup>().sysclk_Hz;
  }
};

Start start(int style, const FullClock& part, const std::string& more = "") {
  BoardSetup setup{image("starts" + std::to_string(style) + part.letter), kMarks};
  setup.mcu = part.mcu;
  setup.more = R"("ns_per_instruction":0)" + more;
  Start start{run_for(setup, 25), std::vector<double>(kMarks.size(), -1.0)};
  for (const Message* call : start.run.of(io::Kind::function_call)) {
    start.reached_ns[call->head.port] = static_cast<double>(call->as<io::FunctionCall>().entry_ns);
  }
  return start;
}

void expect_within(double low, double value, double high, const std::string& what) {
  EXPECT_GE(value, low) << what;
  EXPECT_LE(value, high) << what;
}

// A hundred instructions or so on the reset clock, and a turn of each loop beyond its flag.
TEST(StartUp, EachStyleReachesItsClocksAsSoonAsCrystalAndPllAreReady) {
  for (const FullClock& part : kParts) {
    for (int style = 1; style <= 4; ++style) {
      const Start s = start(style, part);
      const std::string what = part.mcu + (" in style " + std::to_string(style));
      EXPECT_EQ(s.sysclk_Hz(), part.sysclk_Hz) << what << s.run.error.message();
      constexpr double kWaits_ns = 2'200'000;
      expect_within(kWaits_ns, s.reached_ns[ready], kWaits_ns + 400 / part.reset_Hz * 1e9, what);
      EXPECT_LT(s.reached_ns[given_up], 0) << what;
      EXPECT_FALSE(s.run.found("given up")) << what;
    }
  }
}

// A time-out is of the image's own making: 100 ms of ticks outlast a crystal of 20 ms, 5 ms do not.
TEST(StartUp, ATimeOutRunsAsLongAsItSays) {
  for (const FullClock& part : kParts) {
    const std::string late = R"(,"hse_start_ns":20000000)";
    EXPECT_LT(start(3, part, late).reached_ns[given_up], 0) << part.mcu;
    const Start given = start(4, part, R"(,"hse_start_ns":5100000)");
    expect_within(5'000'000, given.reached_ns[given_up], 5'110'000, part.mcu);
  }
}

TEST(Delays, RunAsLongAsTheTablesSay) {
  for (const FullClock& part : kParts) {
    const double cycle_ns = 1e9 / part.sysclk_Hz;
    for (int style = 1; style <= 4; ++style) {
      const Start s = start(style, part);
      const std::string what = part.mcu + (" in style " + std::to_string(style));
      // SUBS 1, BNE 1 + P. With the line cache the loop lies in it; without, its line may be read again
      // in each turn.
      const double again = part.line_cache ? 0 : part.wait_states;
      expect_within(100'000 * 3 * cycle_ns, s.took_ns(loop_end),
                    1.001 * 100'000 * (5 + again) * cycle_ns, what);
      // The last turn may begin just before the time is over: LDR 2, SUBS 1, CMP 1, B 4, wait states;
      // the call of the mark and the set-up before, some 50 cycles.
      const double millisecond = 1e6, turn = 150 * cycle_ns;
      expect_within(millisecond, s.took_ns(dwt_end), millisecond + turn, what);
      expect_within(millisecond, s.took_ns(systick_end), millisecond + turn, what);
      expect_within(5 * millisecond, s.took_ns(tick_end), 5 * millisecond + turn, what);
    }
  }
}

}  // namespace
}  // namespace whirl::board_test

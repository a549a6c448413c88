// Oscillators that are off: the core's own count is as ever, the world's time is not.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

struct PartUnderTest {
  const char *letter, *mcu, *terminal;
  std::uint32_t hsi_cycles;  // a millisecond of HSI: 16 MHz (RM0090 7.2.2), 8 MHz (RM0008 7.2.2)
};
constexpr PartUnderTest kParts[] = {{"_f4", "stm32f405rg", "usart2", 16000},
                                    {"_f1", "stm32f103cb", "usart1", 8000}};
constexpr std::uint32_t kCrystal_cycles = 8000;
constexpr int kTick = 15;  // the exception's number

BoardRun ticks_of(const std::string& name, const PartUnderTest& part, const std::string& errors) {
  BoardSetup setup{image(name + part.letter), {}};
  setup.mcu = part.mcu;
  setup.more = R"("ns_per_instruction":0)" + errors +
               R"(,"devices":[{"name":"terminal","type":"serial","baud":115200,"bus":")" +
               part.terminal + R"("}])";
  return run_for(setup, 60);
}

// Mean of the periods of the ticks: where a core goes on after a sleep is an edge of its clock.
double period_ns(const BoardRun& run) {
  std::vector<std::int64_t> raised;
  for (const Message* message : run.of(io::Kind::interrupt_latency)) {
    if (message->head.port == kTick)
      raised.push_back(message->as<io::InterruptLatency>().raised_ns);
  }
  if (raised.size() < 50) return 0.0;
  return static_cast<double>(raised.back() - raised.front()) /
         static_cast<double>(raised.size() - 1);
}

void expect_cycles(const BoardRun& run, std::uint32_t cycles) {
  const auto values = run.numbers();
  EXPECT_GT(values.size(), 50u);
  for (const std::uint32_t value : values)
    EXPECT_TRUE(near(value, cycles, stated(1, "asleep, to the ns")));  // asleep, to the ns
}

struct Off {
  const char* key;
  double share;
};

TEST(Oscillators, ATickOfHsiComesEarlierByWhatHsiIsFaster) {
  for (const PartUnderTest& part : kParts) {
    for (const Off& off : {Off{"", 0.0},
                           {R"(,"hsi_error":0.01)", 0.01},
                           {R"(,"hsi_error":-0.025)", -0.025},
                           {R"(,"hse_error":0.001)", 0.0}}) {
      const BoardRun run = ticks_of("oscillators", part, off.key);
      EXPECT_TRUE(near(period_ns(run), 1e6 / (1.0 + off.share),
                       stated(0.2, "whole nanoseconds over fifty")))
          << part.mcu << off.key;
      expect_cycles(run, part.hsi_cycles);
      EXPECT_FALSE(run.found("terminal")) << part.mcu << off.key;
    }
  }
}

TEST(Oscillators, ACrystalOfFiftyMillionthsIsThatMuchOff) {
  for (const PartUnderTest& part : kParts) {
    for (const Off& off : {Off{R"(,"hse_error":50e-6)", 50e-6},
                           {R"(,"hse_error":-50e-6)", -50e-6},
                           {R"(,"hsi_error":0.01)", 0.0}}) {
      const BoardRun run = ticks_of("oscillators_crystal", part, off.key);
      EXPECT_TRUE(near(period_ns(run), 1e6 / (1.0 + off.share),
                       stated(0.2, "whole nanoseconds over fifty")))
          << part.mcu << off.key;
      expect_cycles(run, kCrystal_cycles);
    }
  }
}

// 16 and 8 MHz divided for 115200 baud: 139 and 69, 0.08 % below and 0.6 % above. A receiver takes 3 %.
TEST(Oscillators, ATerminalThatIsTooFarOffIsSaid) {
  for (const PartUnderTest& part : kParts) {
    EXPECT_FALSE(ticks_of("oscillators", part, R"(,"hsi_error":0.02)").found("sent to at"));
    EXPECT_TRUE(ticks_of("oscillators", part, R"(,"hsi_error":0.04)").found("sent to at"))
        << part.mcu;
    EXPECT_TRUE(ticks_of("oscillators", part, R"(,"hsi_error":-0.04)").found("sent to at"))
        << part.mcu;
  }
}

TEST(Oscillators, APartWithoutAnOscillatorHasNoneThatIsOff) {
  BoardSetup setup{image("busy"), {}};
  setup.more = R"("hsi_error":0.01)";
  const BoardRun run = run_for(setup, 1);
  EXPECT_EQ(run.error.kind, ErrorKind::bad_input);
  EXPECT_NE(run.error.message().find("hsi_error"), std::string::npos) << run.error.message();
}

}  // namespace
}  // namespace whirl::board_test

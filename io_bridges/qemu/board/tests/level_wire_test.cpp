// An analog level between two boards, each a part with its own DAC and converter (RM0090 chapters 13 and 14): DAC channel 1 of
// the one at PC0 of the other.
#include "io_bridges/qemu/board/level_wire.hpp"

#include "base/near.hpp"
#include "io_bridges/qemu/board/tests/two_boards.hpp"
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"

namespace whirl::board {
namespace {

constexpr std::uint32_t kDac = 0x40007400, kDhr12r1 = kDac + 8;
constexpr std::uint32_t kAdc = 0x40012000, kCr2 = kAdc + 8, kSqr3 = kAdc + 0x34, kDr = kAdc + 0x4C;
constexpr Nanoseconds kLatency_ns = 100'000, kSet_up_ns = 4'000'000;
constexpr Nanoseconds kConversion_ns = 1'000;  // 15 clocks of 21 MHz are less

struct LevelBoard {
  LevelBoard() {
    bench.clock_168();
    bench.set_bits(0x40023830, 1u << 2);
    bench.set_bits(0x40023840, 1u << 29);
    bench.set_bits(0x40023844, 1u << 8);
    bench.put(kAdc + 0x304, 1u << 16);
    bench.put(kSqr3, 10);
    bench.put(kCr2, 1);
    bench.put(kDac, 1);
    bench.run(kSet_up_ns - bench.now());
  }
  void at(Nanoseconds when, std::function<void()> what) {
    plans.push_back(std::make_unique<io::Event>(bench.events(), std::move(what)));
    plans.back()->at(when);
  }
  void put_out(Nanoseconds when, std::uint32_t code) {
    at(when, [this, code] { bench.put(kDhr12r1, code); });
  }
  void measure(Nanoseconds when) {
    at(when, [this] { bench.put(kCr2, 1u | 1u << 30); });
    at(when + kConversion_ns, [this] { got.push_back(bench.get(kDr)); });
  }
  void step(Nanoseconds from, Nanoseconds to) {
    wired_step(bench.events(), ends, from, to, closed);
  }

  stm32::ChipBench bench;
  bool closed = false;
  WireEnds ends{{bench.events(), [](const io::Finding&) {}, [this] { closed = true; }}};
  std::vector<std::unique_ptr<io::Event>> plans;
  std::vector<std::uint32_t> got;
};

class FarLevel : public TwoBoards<LevelBoard> {
 protected:
  FarLevel() {
    now_ns_ = kSet_up_ns;
    auto& leader = here_.ends.lead(end()).value()->port<LeaderLevel>(0, kLatency_ns);
    here_.bench.chip().set_analog("PC0", [&](Nanoseconds now) { return leader.volts(now); });
    auto& follower = there_.ends.follow(end(), true).value()->port<FollowerLevel>(0);
    there_.bench.chip().on_dac(1, [&](double level_V) { follower.put(level_V); });
  }
};

TEST_F(FarLevel, NothingPutOutIsZero) {
  here_.measure(kSet_up_ns + 500'000);
  run(1);
  EXPECT_EQ(here_.got, (std::vector<std::uint32_t>{0}));
}

// Also over a boundary, and wherever in the grain at which the leader asks.
TEST_F(FarLevel, ALevelIsMeasuredOnceItsLatencyHasPassedAndNotBefore) {
  std::vector<std::uint32_t> expected;
  for (Nanoseconds k = 0; k < 40; ++k) {
    const Nanoseconds when = kSet_up_ns + 250'000 * k + 1'171 * k;
    const auto code = static_cast<std::uint32_t>(100 * (k + 1));
    there_.put_out(when, code);
    here_.measure(when + kLatency_ns - 2'000);
    here_.measure(when + kLatency_ns + 10);
    expected.push_back(code - 100);
    expected.push_back(code);
  }
  run(12);
  EXPECT_EQ(here_.got, expected);
}

TEST_F(FarLevel, AChannelThatIsSwitchedOffIsZero) {
  there_.put_out(kSet_up_ns + 100'000, 2000);
  there_.at(kSet_up_ns + 400'000, [this] { there_.bench.put(kDac, 0); });
  here_.measure(kSet_up_ns + 400'000);
  here_.measure(kSet_up_ns + 600'000);
  run(1);
  EXPECT_EQ(here_.got, (std::vector<std::uint32_t>{2000, 0}));
}

}  // namespace
}  // namespace whirl::board

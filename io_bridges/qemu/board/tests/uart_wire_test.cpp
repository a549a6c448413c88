// A UART between two boards, each a part with its own USART2 at the rate of its own registers (RM0090 chapter 30, PCLK1
// 42 MHz, TX PA2, RX PA3), with the faults of its own end of the wire.
#include "io_bridges/qemu/board/uart_wire.hpp"

#include "io_bridges/devices/wire_faults.hpp"
#include "io_bridges/qemu/board/tests/two_boards.hpp"
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"

namespace whirl::board {
namespace {

constexpr std::uint32_t kUsart = 0x40004400, kSr = kUsart, kDr = kUsart + 4, kBrr = kUsart + 8,
                        kCr1 = kUsart + 0xC;
constexpr std::uint32_t PE = 1, FE = 2, RXNE = 32;
constexpr std::uint32_t kUe_te_re_rxneie = 0x202C, kTe = 8, kSbk = 1, k9_even_parity = 0x1400;
constexpr int kIrq = 38;  // USART2
constexpr std::uint32_t k115200 = 365, k57600 = 729;
constexpr Nanoseconds kCharacter_ns = 86'905;  // 10 bits x 365 / 42 MHz
constexpr Nanoseconds kLatency_ns = 84'201;    // ten bits at 115200 baud, but for 3 %
constexpr Nanoseconds kSet_up_ns = 4'000'000;

struct Got {
  Nanoseconds at = 0;
  std::uint32_t byte = 0, errors = 0;
  bool operator==(const Got&) const = default;
};
void PrintTo(const Got& got, std::ostream* out) {
  *out << got.byte << " at " << got.at << " errors " << got.errors;
}

struct UartBoard {
  UartBoard() {
    bench.clock_168();
    bench.set_bits(0x40023840, 1u << 17);
    bench.set_bits(0x40023830, 1u << 21);
    bench.mux('A', 2, 7);
    bench.mux('A', 3, 7);
    bench.put(kBrr, k115200);
    bench.put(kCr1, kUe_te_re_rxneie);
    bench.on_irq = [this](int irq, bool level) {
      if (irq != kIrq || !level) return;
      const std::uint32_t status = bench.get(kSr);
      if ((status & RXNE) == 0) return;
      got.push_back({bench.now(), bench.get(kDr) & 0xFF, status & (PE | FE)});
    };
    bench.run(kSet_up_ns - bench.now());
  }
  void join(io::UartPeer& port) {
    faults = std::make_unique<io::UartWireFaults>(bench.events(), book, port, 2, 1,
                                                  io::UartWireFaults::Spoils::both_ways);
    bench.chip().join_uart(2, *faults);
  }
  // As a driver does: when DR is empty, from `when` on.
  void say(Nanoseconds when, std::vector<std::uint8_t> bytes) {
    at(when, [this, bytes] {
      bench.put(kDr, bytes.front());
      const std::vector<std::uint8_t> rest(bytes.begin() + 1, bytes.end());
      if (!rest.empty()) say(bench.now() + kCharacter_ns, rest);
    });
  }
  void at(Nanoseconds when, std::function<void()> what) {
    plans.push_back(std::make_unique<io::Event>(bench.events(), std::move(what)));
    plans.back()->at(when);
  }
  void broken(Nanoseconds from, Nanoseconds to) {
    book.add({1, io::FaultKind::uart_silence, from, to, 2, io::kAnywhere, 0, 0.0});
  }
  void noisy() { book.add({1, io::FaultKind::uart_flip, 0, io::kNever, 2, io::kAnywhere, 0, 1.0}); }
  void step(Nanoseconds from, Nanoseconds to) {
    wired_step(bench.events(), ends, from, to, closed);
  }

  stm32::ChipBench bench;
  std::vector<io::Finding> findings;
  bool closed = false;
  WireEnds ends{{bench.events(), [this](const io::Finding& f) { findings.push_back(f); },
                 [this] { closed = true; }}};
  io::FaultBook book;
  std::unique_ptr<io::UartWireFaults> faults;
  std::vector<std::unique_ptr<io::Event>> plans;
  std::vector<Got> got;
};

class FarUart : public TwoBoards<UartBoard> {
 protected:
  FarUart() { now_ns_ = kSet_up_ns; }
  void join(Nanoseconds latency_ns = kLatency_ns) {
    here_.join(here_.ends.lead(end()).value()->port<LeaderUart>(0, latency_ns));
    there_.join(
        there_.ends.follow(end(), true).value()->port<FollowerUart>(0, "usart2", latency_ns));
  }
};

// Also from one step to the next, and both at the same time.
TEST_F(FarUart, ACharacterIsThereWhenItsLastStopBitHasPassedBothWays) {
  join();
  here_.say(4'100'000, {'a', 'b'});
  there_.say(4'950'000, {'x', 'y', 'z'});
  here_.say(4'960'000, {'c'});
  run(2);
  EXPECT_EQ(there_.got, (std::vector<Got>{{4'100'000 + kCharacter_ns, 'a', 0},
                                          {4'100'000 + 2 * kCharacter_ns, 'b', 0},
                                          {4'960'000 + kCharacter_ns, 'c', 0}}));
  EXPECT_EQ(here_.got, (std::vector<Got>{{4'950'000 + kCharacter_ns, 'x', 0},
                                         {4'950'000 + 2 * kCharacter_ns, 'y', 0},
                                         {4'950'000 + 3 * kCharacter_ns, 'z', 0}}));
  EXPECT_TRUE(here_.findings.empty());
  EXPECT_TRUE(there_.findings.empty());
}

// Wherever in the grain at which the leader asks.
TEST_F(FarUart, TheFollowersCharacterIsInTimeWheneverItBegins) {
  join();
  std::vector<Got> expected;
  for (Nanoseconds k = 0; k < 80; ++k) {
    const Nanoseconds when = kSet_up_ns + 100'000 * k + 1'171 * k;
    there_.say(when, {static_cast<std::uint8_t>(k)});
    expected.push_back({when + kCharacter_ns, static_cast<std::uint32_t>(k), 0});
  }
  run(10);
  EXPECT_EQ(here_.got, expected);
}

TEST_F(FarUart, EachSamplesAtItsOwnRate) {
  join();
  here_.bench.put(kBrr, k57600);
  there_.say(4'100'000, {0x55});
  here_.say(4'400'000, {0x0F});
  run(1);
  ASSERT_EQ(here_.got.size(), 1u);
  EXPECT_NE(here_.got[0].byte, 0x55u);
  // Twice as long: all that the faster one sees are the start bit and three ones and a half, no stop bit.
  ASSERT_EQ(there_.got.size(), 1u);
  EXPECT_EQ(there_.got[0].byte, 0xFEu);
  EXPECT_EQ(there_.got[0].at, 4'400'000 + 173'571);
}

// 3 % is within what ten bits allow, 7 % is not (RM0090 30.3.5).
TEST_F(FarUart, ARateThatIsFarOffIsAFramingError) {
  join();
  for (const auto& [divider, errors] : {std::pair{376u, 0u}, std::pair{391u, FE}}) {
    there_.got.clear();
    here_.bench.put(kBrr, divider);
    here_.say(now_ns_ + 100'000, {0x00, 0x00});
    run(1);
    ASSERT_EQ(there_.got.size(), 2u);
    EXPECT_EQ(there_.got[0].errors, errors) << divider;
  }
}

TEST_F(FarUart, ParityAndBreakPassAsTheyWereSent) {
  join();
  there_.bench.put(kCr1, kUe_te_re_rxneie | k9_even_parity);
  there_.say(4'200'000, {0x01});
  there_.say(4'600'000, {0x03});
  run(1);
  // Eight bits: the parity bit stands where it wants a stop bit.
  EXPECT_EQ(here_.got,
            (std::vector<Got>{{4'200'000 + 95'595, 0x01, 0}, {4'600'000 + 95'595, 0x03, FE}}));
  there_.bench.put(kCr1, kUe_te_re_rxneie | kSbk);
  run(1);
  ASSERT_EQ(here_.got.size(), 3u);
  EXPECT_EQ(here_.got[2].byte, 0u);
  EXPECT_EQ(here_.got[2].errors, FE);
}

// A transmitter that is switched on sends a frame of ones: an idle line.
TEST_F(FarUart, AnIdleFrameIsNoCharacter) {
  join();
  there_.at(4'100'000, [this] {
    there_.bench.put(kCr1, kUe_te_re_rxneie & ~kTe);
    there_.bench.put(kCr1, kUe_te_re_rxneie);
  });
  run(1);
  EXPECT_TRUE(here_.got.empty());
}

TEST_F(FarUart, ABrokenWireIsSilentForBothEndsWhicheverOneHasTheFault) {
  join();
  here_.broken(4'000'000, 5'000'000);
  there_.broken(5'000'000, 6'000'000);
  for (const Nanoseconds when : {4'100'000, 5'100'000, 6'100'000}) {
    here_.say(when, {'h'});
    there_.say(when, {'t'});
  }
  run(3);
  EXPECT_EQ(there_.got, (std::vector<Got>{{6'100'000 + kCharacter_ns, 'h', 0}}));
  EXPECT_EQ(here_.got, (std::vector<Got>{{6'100'000 + kCharacter_ns, 't', 0}}));
}

TEST_F(FarUart, NoiseAtOneEndSpoilsWhatBothHear) {
  join();
  there_.noisy();
  here_.say(4'100'000, {0x55});
  there_.say(4'100'000, {0x55});
  run(1);
  ASSERT_EQ(here_.got.size(), 1u);
  ASSERT_EQ(there_.got.size(), 1u);
  EXPECT_EQ(__builtin_popcount(here_.got[0].byte ^ 0x55), 1);
  EXPECT_EQ(__builtin_popcount(there_.got[0].byte ^ 0x55), 1);
}

TEST_F(FarUart, AFollowerThatIsFasterThanTheWireIsForIsToldAndStillHeard) {
  join(10 * kCharacter_ns);
  there_.say(4'100'000, {'x', 'y'});
  run(1);
  ASSERT_EQ(there_.findings.size(), 1u);
  EXPECT_EQ(there_.findings[0].where, "usart2");
  EXPECT_NE(there_.findings[0].what.find("a character of 86905 ns"), std::string::npos);
  // At the second mark after it: half a latency each.
  const Nanoseconds told = 4'000'000 + 2 * 5 * kCharacter_ns;
  EXPECT_EQ(here_.got, (std::vector<Got>{{told, 'x', 0}, {told, 'y', 0}}));
}

TEST_F(FarUart, AClosedWireEndsTheWait) {
  join();
  wire_.value().close();
  here_.step(now_ns_, now_ns_ + kGrain_ns);
  EXPECT_TRUE(here_.closed);
}

}  // namespace
}  // namespace whirl::board

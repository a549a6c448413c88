// Inputs, slaves, repetition, bursts and observers of the timers; times as in timer_test.cpp.
#include "base/near.hpp"
#include "io_bridges/qemu/stm32/timer.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "io_bridges/qemu/stm32/tests/bare_chip.hpp"
#include "io_bridges/qemu/stm32/tests/timer_parts.hpp"

namespace whirl::stm32 {
namespace {

using namespace test;
using namespace tim;

TEST(Timer, CaptureKeepsTheCountOfTheEdgeAndFlagsOvercapture) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  put(timer, PSC, 83);
  put(timer, EGR, 1);
  put(timer, CCMR1, 0x01);
  put(timer, CCER, 1);
  put(timer, SR, 0);
  put(timer, CR1, CEN);
  bare.run_to(1'500'500);
  timer.pin(1).sense(true, bare.events.now());
  EXPECT_EQ(get(timer, SR), CC1IF);
  bare.run_to(1'700'000);
  timer.pin(1).sense(false, bare.events.now());
  EXPECT_EQ(get(timer, CCR1), 1500u);
  EXPECT_EQ(get(timer, SR), 0u);
  timer.pin(1).sense(true, bare.events.now());
  timer.pin(1).sense(false, bare.events.now());
  timer.pin(1).sense(true, bare.events.now());
  EXPECT_EQ(get(timer, SR), CC1IF | CC1OF);
}

// The sequence of RM0090 "PWM input mode": period in CCR1, high time in CCR2.
TEST(Timer, PwmInputMeasuresPeriodAndHighTime) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  put(timer, PSC, 83);
  put(timer, EGR, 1);
  put(timer, CCMR1, 0x0201);  // IC1 on TI1, IC2 on TI1
  put(timer, CCER, 0x31);     // IC2 falling
  put(timer, SMCR, 0x54);     // TI1FP1 resets
  put(timer, SR, 0);
  put(timer, CR1, CEN | URS);
  for (int i = 1; i <= 3; ++i) {
    bare.run_to(i * 2'500'000);
    timer.pin(1).sense(true, bare.events.now());
    bare.run_to(i * 2'500'000 + 1'234'000);
    timer.pin(1).sense(false, bare.events.now());
  }
  EXPECT_EQ(get(timer, CCR1), 2500u);
  EXPECT_EQ(get(timer, CCR2), 1234u);
  EXPECT_EQ(get(timer, SR) & (UIF | TIF), TIF);  // URS: no update flag from resets
}

TEST(Timer, ALongFilterSwallowsAShortPulseAndDelaysALongOne) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  put(timer, CCMR1, 0xF1);  // 8 samples at f_DTS / 32: 256 clocks, 3047.6 ns
  put(timer, CCER, 1);
  put(timer, CR1, CEN);
  bare.run_to(10'000);
  timer.pin(1).sense(true, 10'000);
  bare.run_to(13'000);
  timer.pin(1).sense(false, 13'000);
  bare.run_to(20'000);
  EXPECT_EQ(get(timer, SR) & CC1IF, 0u);
  timer.pin(1).sense(true, 20'000);
  bare.run_to(30'000);
  EXPECT_EQ(get(timer, SR) & CC1IF, CC1IF);
  EXPECT_EQ(get(timer, CCR1), (20'000u + 3'047u) * 84 / 1000 - 1);
}

TEST(Timer, EncoderCountsFourPerCycleAndTurnsBack) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  put(timer, CCMR1, 0x0101);
  put(timer, SMCR, 3);
  put(timer, CR1, CEN);
  bool a = false, b = false;
  const auto edge = [&](int channel, bool& level) {
    level = !level;
    timer.pin(channel).sense(level, bare.events.now());
  };
  for (int cycle = 0; cycle < 3; ++cycle) {
    edge(1, a), edge(2, b), edge(1, a), edge(2, b);
  }
  EXPECT_EQ(get(timer, CNT), 12u);
  EXPECT_EQ(get(timer, CR1) & DIR, 0u);
  edge(2, b), edge(1, a);
  EXPECT_EQ(get(timer, CNT), 10u);
  EXPECT_EQ(get(timer, CR1) & DIR, DIR);
}

// Each resets the other, and each reset is a pulse on TRGO: on the part that swings, here it must not
// go round for ever at one instant.
TEST(Timer, TwoThatResetEachOtherSwingAtTheirSynchronisersPace) {
  BareChip bare;
  Timer a(bare.chip(), general(3)), b(bare.chip(), general(4));
  a.connect_itr(3, b.trgo());
  b.connect_itr(2, a.trgo());
  put(a, SMCR, (3u << 4) | 4);
  put(b, SMCR, (2u << 4) | 4);
  put(a, EGR, 1);
  EXPECT_EQ(get(b, SR) & TIF, TIF);
  put(b, SR, 0);
  bare.run_to(10'000);
  EXPECT_EQ(get(b, SR) & TIF, TIF);
  EXPECT_GT(bare.events.fired(), 100u);  // 840 clocks
  EXPECT_LT(bare.events.fired(), 1000u);
}

// An output that toggles at every reset, wired to the input that resets: a ring of one.
TEST(Timer, AnOutputThatResetsItsOwnTimerSwingsToo) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  timer.pin(1).add_outlet(
      [&](Drive drive, Nanoseconds now) { timer.pin(1).sense(drive == Drive::high, now); });
  timer.pin(1).route(+1);
  put(timer, CCMR1, 0x30);
  put(timer, CCER, 1);
  put(timer, ARR, 100);
  put(timer, SMCR, (4u << 4) | 4);
  put(timer, CR1, CEN);
  put(timer, EGR, 1);
  bare.run_to(10'000);
  EXPECT_GT(bare.events.fired(), 100u);
  EXPECT_LT(bare.events.fired(), 2000u);
}

TEST(Timer, AMastersUpdateClocksItsSlave) {
  BareChip bare;
  Timer master(bare.chip(), general(3)), slave(bare.chip(), general(4));
  slave.connect_itr(2, master.trgo());
  put(slave, SMCR, (2u << 4) | 7);
  put(slave, CR1, CEN);
  put(master, ARR, 83);
  put(master, CR2, 2u << 4);
  put(master, CR1, CEN);
  bare.run_to(1'000'012);
  EXPECT_EQ(get(slave, CNT), 1000u);
}

TEST(Timer, OnePulseStopsAtTheUpdate) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  put(timer, ARR, 839);
  put(timer, CR1, CEN | OPM);
  bare.run_to(5'000);
  EXPECT_EQ(get(timer, CR1) & CEN, CEN);
  bare.run_to(15'000);
  EXPECT_EQ(get(timer, CR1) & CEN, 0u);
  EXPECT_EQ(get(timer, CNT), 0u);
}

TEST(Timer, UpdateDisableStillReinitialisesOnUgButFlagsNothing) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  put(timer, CNT, 77);
  put(timer, CR1, UDIS);
  put(timer, EGR, 1);
  EXPECT_EQ(get(timer, CNT), 0u);
  EXPECT_EQ(get(timer, SR) & UIF, 0u);
}

TEST(Timer, RepetitionCounterUpdatesEveryFourthOverflow) {
  BareChip bare;
  Timer timer(bare.chip(), advanced());
  put(timer, ARR, 167);
  put(timer, RCR, 3);
  put(timer, EGR, 1);
  put(timer, SR, 0);
  put(timer, DIER, 1);
  put(timer, CR1, CEN);
  bare.run_to(edge_ns(1 + 4 * 168, 168'000'000) - 1);
  EXPECT_FALSE(bare.interrupts.lines[25]);
  bare.run_to(edge_ns(1 + 4 * 168, 168'000'000));
  EXPECT_TRUE(bare.interrupts.lines[25]);
}

TEST(Timer, ABurstWritesItsRegistersOnOneRequest) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  put(timer, ARR, 83);
  put(timer, DCR, (2u << 8) | (CCR1 / 4));  // three transfers from CCR1 on
  put(timer, DIER, UDE);
  int served = 0;
  DmaRequest& request = timer.update_request();
  request.on_change([&](bool level) {
    if (!level) return;
    while (request.level() && served < 100) {
      put(timer, DMAR, static_cast<std::uint32_t>(10 + served++));
      request.served();
    }
  });
  put(timer, CR1, CEN);
  bare.run_to(1'500);
  EXPECT_EQ(served, 3);
  EXPECT_EQ(get(timer, CCR1), 10u);
  EXPECT_EQ(get(timer, CCR2), 11u);
  EXPECT_EQ(get(timer, CCR3), 12u);
}

TEST(Timer, TheObserverHearsChangesOnlyAtTheirMoment) {
  BareChip bare;
  Timer timer(bare.chip(), general(4));
  put(timer, ARR, 4199);
  put(timer, CCMR1, 0x68);
  put(timer, CCR1, 420);
  put(timer, CCER, 1);
  put(timer, EGR, 1);
  put(timer, CR1, CEN);
  std::vector<PwmPattern> patterns;
  timer.observe_pwm([&](const PwmPattern& pattern) { patterns.push_back(pattern); });
  bare.run_to(1'000'000);
  ASSERT_EQ(patterns.size(), 1u);
  EXPECT_TRUE(near(patterns[0].period_s, 50e-6, round_off(4, 50e-6)));
  EXPECT_TRUE(near(patterns[0].channel[0].duty, 0.1, round_off(4, 0.1)));
  put(timer, CCR1, 840);
  bare.run_to(1'100'000);
  ASSERT_EQ(patterns.size(), 2u);
  EXPECT_TRUE(near(patterns[1].channel[0].duty, 0.2, round_off(4, 0.2)));
  EXPECT_EQ(patterns[1].t_ns, edge_ns(1 + 20 * 4200, 84'000'000));
  EXPECT_EQ(patterns[1].period_start_ns, patterns[1].t_ns);
}

TEST(Timer, ASilentTimerSetsNoEvent) {
  BareChip bare;
  Timer timer(bare.chip(), advanced());
  put(timer, ARR, 8399);
  put(timer, CCMR1, 0x68);
  put(timer, CCR1, 100);
  put(timer, CCER, 1);
  put(timer, BDTR, MOE);
  put(timer, CR1, CEN);
  EXPECT_EQ(bare.events.next_deadline(), io::kNever);
}

}  // namespace
}  // namespace whirl::stm32

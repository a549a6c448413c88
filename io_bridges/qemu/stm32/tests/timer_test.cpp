// Times here follow from the clock alone: 84 MHz on APB1 (11.904762 ns), 168 MHz on APB2
// (5.952381 ns), and from RM0090's rule that CNT_EN follows CEN by one clock.
#include "io_bridges/qemu/stm32/timer.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "io_bridges/qemu/stm32/tests/bare_chip.hpp"

namespace whirl::stm32 {
namespace {

using namespace test;
using namespace tim;

TimerConfig general(int number = 3) {
  TimerConfig config;
  config.number = number;
  config.kind = TimerKind::general_16;
  config.update_irq = 29;
  return config;
}

TimerConfig advanced() {
  TimerConfig config;
  config.number = 1;
  config.kind = TimerKind::advanced;
  config.on_apb2 = true;
  config.update_irq = 25;
  config.compare_irq = 27;
  config.trigger_irq = 26;
  config.break_irq = 24;
  return config;
}

// The first clock edge at which n clocks of f have passed since t = 0.
Nanoseconds edge_ns(std::int64_t n, std::int64_t f_Hz) {
  return (n * 1'000'000'000 + f_Hz - 1) / f_Hz;
}

TEST(Timer, UpdateComesAfterPrescalerTimesPeriodClocksPlusTheEnableClock) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  put(timer, PSC, 83);
  put(timer, ARR, 999);
  put(timer, EGR, 1);  // loads the prescaler
  put(timer, SR, 0);
  put(timer, DIER, 1);
  put(timer, CR1, CEN);
  const Nanoseconds due = edge_ns(1 + 84 * 1000, 84'000'000);
  bare.run_to(due - 1);
  EXPECT_FALSE(bare.interrupts.lines[29]);
  bare.run_to(due);
  EXPECT_TRUE(bare.interrupts.lines[29]);
  EXPECT_EQ(get(timer, CNT), 0u);
  put(timer, SR, ~UIF);
  EXPECT_FALSE(bare.interrupts.lines[29]);
  bare.run_to(edge_ns(1 + 84 * 2000, 84'000'000));
  EXPECT_TRUE(bare.interrupts.lines[29]);
}

TEST(Timer, AnHourOfCountingDoesNotDrift) {
  BareChip bare;
  TimerConfig config = general(2);
  config.kind = TimerKind::general_32;
  Timer timer(bare.chip(), config);
  put(timer, PSC, 83);
  put(timer, EGR, 1);
  put(timer, CR1, CEN);
  bare.run_to(3600'000'000'000 + 12);  // the enable clock is 12 ns
  EXPECT_EQ(get(timer, CNT), 3'600'000'000u);
}

TEST(Timer, ManyPeriodsAtOnceEqualManyLooks) {
  BareChip lazy, eager;
  Timer a(lazy.chip(), advanced()), b(eager.chip(), advanced());
  for (Timer* timer : {&a, &b}) {
    put(*timer, PSC, 6);
    put(*timer, ARR, 1000);
    put(*timer, RCR, 2);
    put(*timer, CCMR1, 0x30);  // toggle on match
    put(*timer, CCR1, 400);
    put(*timer, CCER, 1);
    put(*timer, BDTR, MOE);
    put(*timer, EGR, 1);
    put(*timer, CR1, CEN | (2u << 5));
  }
  for (Nanoseconds t = 1000; t <= 5'000'000; t += 1000) {
    eager.run_to(t);
    get(b, CNT);
  }
  lazy.run_to(5'000'000);
  EXPECT_EQ(get(a, CNT), get(b, CNT));
  EXPECT_EQ(get(a, CR1), get(b, CR1));
  EXPECT_EQ(a.output(1, false), b.output(1, false));
  Nanoseconds updated[2] = {};
  int i = 0;
  for (BareChip* bare : {&lazy, &eager}) {
    Timer& timer = bare == &lazy ? a : b;
    put(timer, SR, 0);
    put(timer, DIER, 1);
    while (!bare->interrupts.lines[25]) bare->run_to(bare->events.next_deadline());
    updated[i++] = bare->events.now();
  }
  EXPECT_EQ(updated[0], updated[1]);
}

TEST(Timer, CentreAlignedCountsToArrAndBackAndUpdatesAtBothEnds) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  put(timer, ARR, 8);
  put(timer, EGR, 1);
  put(timer, SR, 0);
  put(timer, CR1, CEN | (1u << 5));
  const int counts[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 7, 6, 5, 4, 3, 2, 1, 0, 1};
  for (int i = 0; i < 18; ++i) {
    bare.run_to(edge_ns(1 + i, 84'000'000));
    EXPECT_EQ(get(timer, CNT), static_cast<std::uint32_t>(counts[i])) << i;
    const bool update = i == 8 || i == 16;
    EXPECT_EQ((get(timer, SR) & UIF) != 0, update) << i;
    put(timer, SR, 0);
  }
}

// RM0090 figure "Center-aligned PWM waveforms (ARR=8)".
TEST(Timer, CompareFlagsInCentreAlignedModesAreThoseOfTheManualsFigure) {
  struct Row {
    std::uint32_t cms, ccr;
    std::vector<int> flagged_at;  // steps after the start at 0
  };
  const Row rows[] = {{1, 4, {12}}, {2, 4, {4}}, {3, 4, {4, 12}}, {2, 7, {7}},  {1, 8, {8}},
                      {2, 8, {8}},  {3, 8, {8}}, {1, 9, {8}},     {2, 0, {16}}, {1, 0, {16}}};
  for (const Row& row : rows) {
    BareChip bare;
    Timer timer(bare.chip(), general());
    put(timer, ARR, 8);
    put(timer, CCMR1, 0x60);
    put(timer, CCR1, row.ccr);
    put(timer, EGR, 1);
    put(timer, SR, 0);
    put(timer, CR1, CEN | (row.cms << 5));
    std::vector<int> flagged;
    for (int i = 1; i <= 16; ++i) {
      bare.run_to(edge_ns(1 + i, 84'000'000));
      if ((get(timer, SR) & CC1IF) != 0) flagged.push_back(i);
      put(timer, SR, 0);
    }
    EXPECT_EQ(flagged, row.flagged_at) << "CMS " << row.cms << " CCR " << row.ccr;
  }
}

// RM0090 figure "Edge-aligned PWM waveforms (ARR=8)".
TEST(Timer, EdgeAlignedPwmIsHighBelowTheCompareValue) {
  for (std::uint32_t ccr : {0u, 4u, 8u, 9u}) {
    BareChip bare;
    Timer timer(bare.chip(), general());
    put(timer, ARR, 8);
    put(timer, CCMR1, 0x60);
    put(timer, CCR1, ccr);
    put(timer, CCER, 1);
    put(timer, EGR, 1);
    put(timer, CR1, CEN);
    std::uint32_t high = 0;
    for (int i = 9; i < 18; ++i) {
      bare.run_to(edge_ns(1 + i, 84'000'000));
      if (timer.output(1, false) == Drive::high) ++high;
    }
    EXPECT_EQ(high, ccr);
  }
}

// RM0090 figure "Center-aligned PWM waveforms (ARR=8)": CCR = 4 is high for 8 of 16 steps, around 0.
TEST(Timer, CentreAlignedPwmIsHighAroundZeroAndDownCountingUpToTheCompareValue) {
  struct Row {
    std::uint32_t cr1;
    std::vector<int> low;  // steps of one period in which OCxREF is low
  };
  const Row rows[] = {{CEN | (1u << 5), {4, 5, 6, 7, 8, 9, 10, 11}},
                      {CEN | DIR, {0, 1, 2, 3}}};  // counts 8 7 6 5, then 4 3 2 1 0 high
  for (const Row& row : rows) {
    BareChip bare;
    Timer timer(bare.chip(), general());
    put(timer, ARR, 8);
    put(timer, CCMR1, 0x60);
    put(timer, CCR1, 4);
    put(timer, CCER, 1);
    put(timer, CR1, row.cr1 & ~CEN);
    put(timer, EGR, 1);
    put(timer, CR1, row.cr1);
    const int steps = (row.cr1 & DIR) != 0 ? 9 : 16;
    std::vector<int> low;
    for (int i = 0; i < steps; ++i) {
      bare.run_to(edge_ns(1 + i, 84'000'000));
      if (timer.output(1, false) == Drive::low) low.push_back(i);
    }
    EXPECT_EQ(low, row.low);
  }
}

TEST(Timer, PreloadWaitsForTheUpdateAndDirectWritesDoNot) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  put(timer, ARR, 99);
  put(timer, CCMR1, 0x68);  // PWM 1 with preload
  put(timer, CCR1, 50);
  put(timer, CCER, 1);
  put(timer, EGR, 1);
  put(timer, CR1, CEN | ARPE);
  bare.run_to(edge_ns(1 + 60, 84'000'000));
  EXPECT_EQ(timer.output(1, false), Drive::low);
  put(timer, CCR1, 80);
  EXPECT_EQ(timer.output(1, false), Drive::low);
  bare.run_to(edge_ns(1 + 160, 84'000'000));
  EXPECT_EQ(timer.output(1, false), Drive::high);
  put(timer, CCMR1, 0x60);
  put(timer, CCR1, 20);
  EXPECT_EQ(timer.output(1, false), Drive::low);
}

TEST(Timer, ARoutedPinGetsItsEdgesAtTheirClocks) {
  BareChip bare;
  Timer timer(bare.chip(), general());
  std::vector<std::pair<Nanoseconds, Drive>> edges;
  timer.pin(1).add_outlet([&](Drive drive, Nanoseconds now) { edges.emplace_back(now, drive); });
  timer.pin(1).route(1);
  put(timer, ARR, 4199);  // 20 kHz at 84 MHz
  put(timer, CCMR1, 0x68);
  put(timer, CCR1, 1050);
  put(timer, CCER, 1);
  put(timer, EGR, 1);
  put(timer, CR1, CEN);
  bare.run_to(110'000);
  const std::vector<std::pair<Nanoseconds, Drive>> want = {
      {0, Drive::low},
      {0, Drive::high},
      {edge_ns(1 + 1050, 84'000'000), Drive::low},
      {edge_ns(1 + 4200, 84'000'000), Drive::high},
      {edge_ns(1 + 5250, 84'000'000), Drive::low},
      {edge_ns(1 + 8400, 84'000'000), Drive::high}};
  EXPECT_EQ(edges, want);
}

TEST(Timer, DeadTimeDelaysTheRisingEdgeOfBothOutputs) {
  BareChip bare;
  Timer timer(bare.chip(), advanced());
  std::vector<std::pair<Nanoseconds, Drive>> main, low;
  timer.pin(1).add_outlet([&](Drive drive, Nanoseconds now) { main.emplace_back(now, drive); });
  timer.pin_n(1).add_outlet([&](Drive drive, Nanoseconds now) { low.emplace_back(now, drive); });
  timer.pin(1).route(1);
  timer.pin_n(1).route(1);
  put(timer, ARR, 8399);
  put(timer, CCMR1, 0x68);
  put(timer, CCR1, 2100);
  put(timer, CCER, 5);
  put(timer, BDTR, MOE | 84);  // 84 clocks of 168 MHz: 500 ns
  put(timer, EGR, 1);
  put(timer, CR1, CEN);
  bare.run_to(20'000);
  const Nanoseconds fall = edge_ns(1 + 2100, 168'000'000);
  ASSERT_FALSE(main.empty());
  EXPECT_EQ(main.back(), std::make_pair(fall, Drive::low));
  EXPECT_EQ(low.back(), std::make_pair(edge_ns(1 + 2100 + 84, 168'000'000), Drive::high));
  main.clear();
  low.clear();
  bare.run_to(51'000);
  EXPECT_EQ(low.front(), std::make_pair(edge_ns(8401, 168'000'000), Drive::low));
  EXPECT_EQ(main.front(), std::make_pair(edge_ns(8401 + 84, 168'000'000), Drive::high));
}

TEST(Timer, WithoutMainOutputEnableNothingIsDriven) {
  BareChip bare;
  Timer timer(bare.chip(), advanced());
  put(timer, CCMR1, 0x50);  // forced active
  put(timer, CCER, 1);
  EXPECT_EQ(timer.output(1, false), Drive::none);
  put(timer, BDTR, MOE);
  EXPECT_EQ(timer.output(1, false), Drive::high);
  put(timer, EGR, BIF);
  EXPECT_EQ(timer.output(1, false), Drive::none);
  EXPECT_EQ(get(timer, SR), BIF);
  put(timer, CR2, 1u << 8);  // idle state high
  put(timer, BDTR, OSSI);
  EXPECT_EQ(timer.output(1, false), Drive::high);
}

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
  EXPECT_DOUBLE_EQ(patterns[0].period_s, 50e-6);
  EXPECT_DOUBLE_EQ(patterns[0].channel[0].duty, 0.1);
  put(timer, CCR1, 840);
  bare.run_to(1'100'000);
  ASSERT_EQ(patterns.size(), 2u);
  EXPECT_DOUBLE_EQ(patterns[1].channel[0].duty, 0.2);
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

// Times here follow from the clock alone: 84 MHz on APB1 (11.904762 ns), 168 MHz on APB2
// (5.952381 ns), and from RM0090's rule that CNT_EN follows CEN by one clock.
#include "io_bridges/qemu/stm32/timer.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "io_bridges/qemu/stm32/tests/bare_chip.hpp"
#include "io_bridges/qemu/stm32/tests/timer_parts.hpp"

namespace whirl::stm32 {
namespace {

using namespace test;
using namespace tim;

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
// Encoder mode counts down to 0; then CMS alone decides how it goes on: up, from the lower end.
TEST(Timer, CentreAlignedAfterAnEncoderGoesUpFromTheLowerEnd) {
  for (const std::uint32_t cms : {1u, 2u, 3u}) {
    BareChip bare;
    Timer timer(bare.chip(), general());
    put(timer, ARR, 8);
    put(timer, CCMR1, 0x0101);
    put(timer, SMCR, 3);
    put(timer, DIER, 1);
    put(timer, CNT, 2);
    put(timer, CR1, CEN | (cms << 5));
    timer.pin(2).sense(true, 0);
    timer.pin(1).sense(true, 0);
    ASSERT_EQ(get(timer, CNT), 0u);
    ASSERT_EQ(get(timer, CR1) & DIR, DIR);
    put(timer, SMCR, 0);
    bare.run_to(edge_ns(3, 84'000'000));
    EXPECT_EQ(get(timer, CNT), 2u);  // CNT_EN follows CEN by one clock
    EXPECT_EQ(get(timer, CR1) & DIR, 0u);
  }
}

// A counter that stands compares nothing: CCxIE must not storm after the UG of an initialisation.
TEST(Timer, UpdateGenerationWhileStoppedSetsNoCompareFlag) {
  for (const std::uint32_t enabled : {0u, 1u}) {
    BareChip bare;
    Timer timer(bare.chip(), general());
    put(timer, DIER, 2);
    if (enabled != 0) put(timer, CR1, CEN);
    put(timer, EGR, 1);
    EXPECT_EQ((get(timer, SR) & 2u) != 0, enabled != 0);
    EXPECT_EQ(bare.interrupts.lines[29], enabled != 0);
  }
}

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

}  // namespace
}  // namespace whirl::stm32

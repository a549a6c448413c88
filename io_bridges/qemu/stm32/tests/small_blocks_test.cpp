// CRC, watchdogs, RNG, cycle counter, stubs, and the F405's wiring of function blocks.
#include <gtest/gtest.h>

#include "io_bridges/qemu/stm32/crc.hpp"
#include "io_bridges/qemu/stm32/dwt.hpp"
#include "io_bridges/qemu/stm32/function_blocks.hpp"
#include "io_bridges/qemu/stm32/probe_stub.hpp"
#include "io_bridges/qemu/stm32/rng.hpp"
#include "io_bridges/qemu/stm32/tests/bare_chip.hpp"
#include "io_bridges/qemu/stm32/timer.hpp"
#include "io_bridges/qemu/stm32/watchdog.hpp"

namespace whirl::stm32 {
namespace {

using namespace test;

// CRC-32/MPEG-2 of four zero bytes, as every implementation of it prints it.
TEST(Crc, OneZeroWordGivesThePublishedRemainder) {
  Crc crc;
  put(crc, 0x08, 1);
  put(crc, 0x00, 0);
  EXPECT_EQ(get(crc, 0x00), 0xC704DD7Bu);
  put(crc, 0x08, 1);
  EXPECT_EQ(get(crc, 0x00), 0xFFFFFFFFu);
  put(crc, 0x04, 0x1A5);
  EXPECT_EQ(get(crc, 0x04), 0xA5u);
}

// A message followed by its own remainder leaves none.
TEST(Crc, AMessageWithItsRemainderLeavesZero) {
  Crc crc;
  for (std::uint32_t word : {0x12345678u, 0xCAFEBABEu, 0u}) put(crc, 0x00, word);
  put(crc, 0x00, get(crc, 0x00));
  EXPECT_EQ(get(crc, 0x00), 0u);
}

TEST(Iwdg, BitesAfterReloadPlusOneTimesPrescalerPeriods) {
  BareChip bare;
  int bites = 0;
  IndependentWatchdog dog(bare.chip(), [&] { ++bites; });
  put(dog, 0x00, 0x5555);
  put(dog, 0x04, 2);    // divides by 16
  put(dog, 0x08, 199);  // 200 * 16 / 32 kHz = 100 ms
  EXPECT_EQ(get(dog, 0x0C), 3u);
  bare.run_to(156'250);  // five periods of 31.25 us
  EXPECT_EQ(get(dog, 0x0C), 0u);
  put(dog, 0x00, 0xAAAA);
  put(dog, 0x00, 0xCCCC);
  bare.run_to(90'000'000);
  put(dog, 0x00, 0xAAAA);
  bare.run_to(189'999'999);
  EXPECT_EQ(bites, 0);
  bare.run_to(190'000'000);
  EXPECT_EQ(bites, 1);
}

TEST(Iwdg, StartedUntouchedItRunsItsReset512Milliseconds) {
  BareChip bare;
  Nanoseconds bitten = 0;
  IndependentWatchdog dog(bare.chip(), [&] { bitten = bare.events.now(); });
  put(dog, 0x08, 5);  // locked: ignored
  put(dog, 0x00, 0xCCCC);
  bare.run_to(1'000'000'000);
  EXPECT_EQ(bitten, 512'000'000);
}

// RM0090 table "Timeout values": 42 MHz, WDGTB 0: T = 0x7F lasts 64 * 4096 / 42 MHz = 6.24 ms.
TEST(Wwdg, WarnsOneCountBeforeItBites) {
  BareChip bare;
  Nanoseconds bitten = 0;
  WindowWatchdog dog(bare.chip(), 0, [&] { bitten = bare.events.now(); });
  put(dog, 0x04, 0x27F);
  put(dog, 0x00, 0xFF);
  const auto counts_ns = [](int n) { return (n * 4096LL * 1000 + 41) / 42; };
  bare.run_to(counts_ns(63) - 1);
  EXPECT_FALSE(bare.interrupts.lines[0]);
  bare.run_to(counts_ns(63));
  EXPECT_TRUE(bare.interrupts.lines[0]);
  EXPECT_EQ(get(dog, 0x00), 0xC0u);
  bare.run_to(10'000'000);
  EXPECT_EQ(bitten, counts_ns(64));
}

TEST(Wwdg, AReloadOutsideTheWindowBitesAtOnce) {
  BareChip bare;
  int bites = 0;
  WindowWatchdog dog(bare.chip(), 0, [&] { ++bites; });
  put(dog, 0x04, 0x50);
  put(dog, 0x00, 0xFF);
  bare.run_to(4'800'000);  // T = 0x7F - 49 = 0x4E: inside
  put(dog, 0x00, 0xFF);
  bare.run_to(4'810'000);
  EXPECT_EQ(bites, 0);
  put(dog, 0x00, 0xFF);
  bare.run_to(4'820'000);
  EXPECT_EQ(bites, 1);
}

TEST(Rng, SameSeedSameWordsAndEachTakesFortyPeriods) {
  std::uint32_t first[2][3];
  for (auto& words : first) {
    BareChip bare;
    Rng rng(bare.chip(), 80, 7);
    put(rng, 0x00, 4);
    for (std::uint32_t& word : words) {
      EXPECT_EQ(get(rng, 0x04), 0u);
      bare.run_to(bare.events.now() + 834);
      EXPECT_EQ(get(rng, 0x04), 1u);
      word = get(rng, 0x08);
    }
  }
  for (int i = 0; i < 3; ++i) EXPECT_EQ(first[0][i], first[1][i]);
  EXPECT_NE(first[0][0], first[0][1]);
}

TEST(Dwt, CountsCoreClocksOnlyWithTraceEnabled) {
  BareChip bare;
  Dwt dwt(bare.chip());
  DebugCore core(dwt);
  put(dwt, 0x00, 1);
  bare.run_to(1'000'000);
  EXPECT_EQ(get(dwt, 0x04), 0u);
  put(core, 0x0C, 1u << 24);
  bare.run_to(2'000'000);
  EXPECT_EQ(get(dwt, 0x04), 168'000u);
  bare.run_to(28'000'000'000);  // wraps at 2^32
  EXPECT_EQ(get(dwt, 0x04), static_cast<std::uint32_t>(27'999'000'000LL * 168 / 1000));
  put(core, 0x0C, 0);
  const std::uint32_t stopped = get(dwt, 0x04);
  bare.run_to(29'000'000'000);
  EXPECT_EQ(get(dwt, 0x04), stopped);
}

TEST(ProbeStub, IsReportedOnceHoweverOftenTouchedAndTakesRequestsBack) {
  BareChip bare;
  ProbeStub stub(bare.chip(), "OTG_FS", 0x50000000, {{0x10, 0x80000000, 0x7C0, 0x37}});
  put(stub, 0x10, 1);
  EXPECT_EQ(get(stub, 0x10), 0x80000000u);
  EXPECT_EQ(get(stub, 0x44), 0u);
  ASSERT_EQ(bare.findings.size(), 1u);
  EXPECT_EQ(bare.findings[0].what, "not modelled: touched first at 0x50000010");
}

// A timer triggers the converter through the part's own wiring: EXTSEL 8 is TIM3_TRGO.
TEST(F405FunctionBlocks, Timer3TriggersTheConverter) {
  BareChip bare;
  FunctionBlockHost host;
  std::vector<Nanoseconds> sampled;
  host.adc_volts = [&](int, int, Nanoseconds t) {
    sampled.push_back(t);
    return 1.0;
  };
  const auto blocks = make_f405_function_blocks(bare.chip(), host);
  Peripheral* adc = nullptr;
  for (const Region& region : blocks->regions()) {
    if (region.base == 0x40012000) adc = region.block;
  }
  ASSERT_NE(adc, nullptr);
  put(*adc, 0x304, 1u << 16);
  put(*adc, 0x08, 1 | 1u << 28 | 8u << 24);
  Timer& timer = *blocks->timer(3);
  put(timer, tim::ARR, 8399);  // 100 us
  put(timer, tim::CR2, 2u << 4);
  put(timer, tim::CR1, 1);
  bare.run_to(350'000);
  ASSERT_EQ(sampled.size(), 3u);
  // 8401 clocks of 84 MHz, the next clock of 21 MHz (the 2101st), and three of it to sample.
  EXPECT_EQ(sampled[0], (2101LL + 3) * 1000 / 21 + 1);
}

TEST(F405FunctionBlocks, SharedLinesStayUpWhileAnySourceHoldsThem) {
  BareChip bare;
  const auto blocks = make_f405_function_blocks(bare.chip(), {});
  Timer &one = *blocks->timer(1), &ten = *blocks->timer(10);
  for (Timer* timer : {&one, &ten}) {
    put(*timer, tim::DIER, 1);
    put(*timer, tim::EGR, 1);
  }
  put(one, tim::SR, 0);
  EXPECT_TRUE(bare.interrupts.lines[25]);
  put(ten, tim::SR, 0);
  EXPECT_FALSE(bare.interrupts.lines[25]);
}

TEST(F405FunctionBlocks, NamesReachSignalsAndRequests) {
  BareChip bare;
  const auto blocks = make_f405_function_blocks(bare.chip(), {});
  EXPECT_EQ(blocks->signal("TIM1_CH2N"), &blocks->timer(1)->pin_n(2));
  EXPECT_EQ(blocks->dma_request("TIM8_UP"), &blocks->timer(8)->update_request());
  EXPECT_NE(blocks->dma_request("ADC3"), nullptr);
  EXPECT_EQ(blocks->signal("TIM14_CH2"), nullptr);
}

// The ESC's way of sampling: TIM1_CC1 starts both converters of an F103.
TEST(F103FunctionBlocks, Timer1CompareStartsBothConvertersAtTheSameInstant) {
  BareChip bare;
  bare.clocks.timclk2 = 72e6;
  FunctionBlockHost host;
  host.adcclk_Hz = [] { return 12e6; };
  std::vector<std::pair<int, Nanoseconds>> sampled;
  host.adc_volts = [&](int adc, int, Nanoseconds t) {
    sampled.emplace_back(adc, t);
    return 1.0;
  };
  const auto blocks = make_f103_function_blocks(bare.chip(), host);
  std::map<std::uint32_t, Peripheral*> at;
  for (const Region& region : blocks->regions()) at[region.base] = region.block;
  Peripheral &one = *at.at(0x40012400), &two = *at.at(0x40012800);
  put(one, 0x04, 6u << 16);
  put(two, 0x08, 1 | 1u << 20 | 7u << 17);
  put(one, 0x08, 1 | 1u << 20);
  Timer& timer = *blocks->timer(1);
  put(timer, tim::ARR, 3599);
  put(timer, tim::CCMR1, 0x70);  // PWM 2: rises at the compare value
  put(timer, tim::CCR1, 1800);
  put(timer, tim::CCER, 1);
  put(timer, tim::EGR, 1);
  put(timer, tim::CR1, 1);
  bare.run_to(60'000);
  ASSERT_EQ(sampled.size(), 2u);
  EXPECT_EQ(sampled[0].second, sampled[1].second);
  // 1801 clocks of 72 MHz, the next clock of 12 MHz (the 301st), 1.5 clocks of it to sample.
  EXPECT_EQ(sampled[0].second, 25'209);
  bare.run_to(70'000);
  EXPECT_NE(get(one, 0x4C) >> 16, 0u);
}

}  // namespace
}  // namespace whirl::stm32

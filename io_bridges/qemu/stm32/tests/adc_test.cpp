// Times follow from ADCCLK: 84 MHz / 4 = 21 MHz on F405 (15 clocks are 714.3 ns), 12 MHz on F103.
#include "io_bridges/qemu/stm32/adc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "io_bridges/qemu/stm32/adc_registers.hpp"
#include "io_bridges/qemu/stm32/tests/bare_chip.hpp"

namespace whirl::stm32 {
namespace {

using namespace test;
using namespace adc;

constexpr std::uint32_t kCommon = 0x300;

Nanoseconds clocks_ns(double clocks, std::int64_t f_Hz) {
  return static_cast<Nanoseconds>(std::ceil(clocks * 1e9 / static_cast<double>(f_Hz)));
}

// Three converters of an F405 at 21 MHz whose inputs show code = 100 * channel + converter.
struct F405Adc {
  BareChip bare;
  std::vector<Nanoseconds> sampled;
  std::vector<int> channels;
  AdcBank bank{bare.chip(), config()};
  AdcF4Block block{bank};

  F405Adc() { put(block, kCommon + CCR, 1u << 16); }
  AdcConfig config() {
    AdcConfig c;
    c.volts = [this](int converter, int channel, Nanoseconds t) {
      sampled.push_back(t);
      channels.push_back(channel);
      return (100.0 * channel + converter) * 3.3 / 4096.0;
    };
    return c;
  }
};

struct F103Adc {
  BareChip bare;
  AdcBank bank{bare.chip(), config()};

  static AdcConfig config() {
    AdcConfig c;
    c.family = AdcFamily::f1;
    c.converters = 2;
    c.adcclk_Hz = [] { return 12e6; };
    c.volts = [](int converter, int channel, Nanoseconds) {
      return (100.0 * channel + converter) * 3.3 / 4096.0;
    };
    return c;
  }
};

TEST(AdcF405, SamplesAfterThreeClocksAndIsDoneAfterFifteen) {
  F405Adc adc;
  put(adc.block, SQR3, 5);
  put(adc.block, CR2, ADON);
  put(adc.block, CR2, ADON | SWSTART_F4);
  adc.bare.run_to(clocks_ns(15, 21'000'000) - 1);
  EXPECT_EQ(get(adc.block, SR), STRT);
  adc.bare.run_to(clocks_ns(15, 21'000'000));
  EXPECT_EQ(get(adc.block, SR), STRT | EOC);
  EXPECT_EQ(get(adc.block, DR), 501u);
  EXPECT_EQ(get(adc.block, SR), STRT);
  EXPECT_EQ(adc.sampled, std::vector<Nanoseconds>{clocks_ns(3, 21'000'000)});
}

TEST(AdcF405, LongSamplingAndLowResolutionTakeTheirTime) {
  F405Adc adc;
  put(adc.block, SMPR2, 7);       // 480 clocks on channel 0
  put(adc.block, CR1, 3u << 24);  // 6 bits: 6 clocks
  put(adc.block, CR2, ADON | SWSTART_F4);
  adc.bare.run_to(clocks_ns(486, 21'000'000) - 1);
  EXPECT_EQ(get(adc.block, SR) & EOC, 0u);
  adc.bare.run_to(clocks_ns(486, 21'000'000));
  EXPECT_EQ(get(adc.block, SR) & EOC, EOC);
}

TEST(AdcF405, CodesStayWithinTheScale) {
  BareChip bare;
  double volts = 0.0;
  AdcConfig config;
  config.volts = [&](int, int, Nanoseconds) { return volts; };
  AdcBank bank(bare.chip(), config);
  struct Row {
    double volts;
    std::uint32_t code;
  };
  // One code is 3.3 V / 4096 = 805.7 uV; the first transition lies half a code above zero.
  for (const Row& row : {Row{-0.5, 0}, Row{0.0, 0}, Row{0.0004, 0}, Row{0.0005, 1}, Row{1.65, 2048},
                         Row{3.3, 4095}, Row{9.0, 4095}}) {
    volts = row.volts;
    put(bank.converter(1), CR2, ADON | SWSTART_F4);
    bare.run_to(bare.events.now() + 10'000);
    EXPECT_EQ(get(bank.converter(1), DR), row.code) << row.volts;
  }
}

TEST(AdcF405, AScanFlagsEachConversionOrOnlyTheLast) {
  for (const bool each : {false, true}) {
    F405Adc adc;
    put(adc.block, CR1, SCAN);
    put(adc.block, SQR1, 2u << 20);
    put(adc.block, SQR3, 1 | 2 << 5 | 3 << 10);
    put(adc.block, CR2, ADON | SWSTART_F4 | (each ? EOCS : 0));
    std::vector<std::uint32_t> seen;
    for (int i = 1; i <= 3; ++i) {
      adc.bare.run_to(clocks_ns(15.0 * i, 21'000'000));
      if ((get(adc.block, SR) & EOC) != 0) seen.push_back(get(adc.block, DR));
    }
    EXPECT_EQ(seen, each ? (std::vector<std::uint32_t>{101, 201, 301})
                         : (std::vector<std::uint32_t>{301}));
  }
}

TEST(AdcF405, UnreadDataUnderDmaAreAnOverrunThatKeepsTheOldValueAndStops) {
  F405Adc adc;
  put(adc.block, SQR3, 4);
  put(adc.block, CR1, OVRIE);
  put(adc.block, CR2, ADON | CONT | DMA | DDS | SWSTART_F4);
  adc.bare.run_to(clocks_ns(15, 21'000'000));
  EXPECT_TRUE(adc.bank.converter(1).request().level());
  EXPECT_FALSE(adc.bare.interrupts.lines[18]);
  adc.bare.run_to(clocks_ns(30, 21'000'000));
  EXPECT_EQ(get(adc.block, SR) & OVR, OVR);
  EXPECT_TRUE(adc.bare.interrupts.lines[18]);
  EXPECT_EQ(adc.bare.events.next_deadline(), io::kNever);
  EXPECT_EQ(get(adc.block, DR), 401u);
}

TEST(AdcF405, WithoutDdsRequestsEndWithTheTransferCount) {
  F405Adc adc;
  int served = 0;
  DmaRequest& request = adc.bank.converter(1).request();
  request.on_change([&](bool level) {
    if (!level) return;
    get(adc.block, DR);
    if (++served == 4) request.transfer_complete();
  });
  put(adc.block, CR2, ADON | CONT | DMA | SWSTART_F4);
  adc.bare.run_to(100'000);
  EXPECT_EQ(served, 4);
  EXPECT_EQ(get(adc.block, SR) & OVR, 0u);
}

TEST(AdcF405, ATriggerEdgeOfTheSelectedPolarityStartsAtTheNextClock) {
  F405Adc adc;
  TriggerLine other, line;
  adc.bank.connect_regular(6, other);
  adc.bank.connect_regular(8, line);
  put(adc.block, CR2, ADON | 2u << 28 | 8u << 24);  // falling edges of number 8
  EXPECT_FALSE(other.wanted());
  EXPECT_TRUE(line.wanted());
  adc.bare.run_to(1000);
  line.set(true, 1000);
  adc.bare.run_to(2000);
  EXPECT_TRUE(adc.sampled.empty());
  line.set(false, 2000);  // 42 clocks of 47.6 ns have passed exactly: this edge is a clock edge
  adc.bare.run_to(3000);
  EXPECT_EQ(adc.sampled, std::vector<Nanoseconds>{clocks_ns(45, 21'000'000)});
}

TEST(AdcF405, ATriggerBetweenClocksWaitsForTheNextWholeOne) {
  F405Adc adc;
  TriggerLine line;
  adc.bank.connect_regular(8, line);
  put(adc.block, CR2, ADON | 1u << 28 | 8u << 24);
  adc.bare.run_to(1'020);  // 21.42 clocks: the half clock at 21.5 does not count
  line.set(true, 1'020);
  adc.bare.run_to(3'000);
  EXPECT_EQ(adc.sampled, std::vector<Nanoseconds>{clocks_ns(22 + 3, 21'000'000)});
}

TEST(AdcF405, AnInjectedGroupInterruptsAndTheRegularConversionStartsAgain) {
  F405Adc adc;
  put(adc.block, CR1, SCAN);
  put(adc.block, SQR3, 7);
  put(adc.block, JSQR, 1u << 20 | 2u << 10 | 3u << 15);  // channels 2 and 3
  put(adc.block, JOFR1, 300);
  put(adc.block, CR2, ADON | SWSTART_F4);
  adc.bare.run_to(clocks_ns(10, 21'000'000));
  put(adc.block, CR2, ADON | JSWSTART_F4);
  adc.bare.run_to(clocks_ns(10 + 30, 21'000'000));
  EXPECT_EQ(get(adc.block, SR) & (JEOC | EOC), JEOC);
  EXPECT_EQ(get(adc.block, JDR1), 0xFFFFu & (201u - 300u));
  EXPECT_EQ(get(adc.block, JDR1 + 4), 301u);
  adc.bare.run_to(clocks_ns(10 + 30 + 15, 21'000'000));
  EXPECT_EQ(get(adc.block, SR) & EOC, EOC);
  EXPECT_EQ(get(adc.block, DR), 701u);
}

TEST(AdcF405, TheWatchdogFlagsCodesOutsideItsWindow) {
  F405Adc adc;
  put(adc.block, HTR, 400);
  put(adc.block, LTR, 200);
  put(adc.block, CR1, AWDEN | AWDIE);
  for (unsigned channel : {1u, 3u, 5u}) {
    put(adc.block, SR, 0);
    put(adc.block, SQR3, channel);
    put(adc.block, CR2, ADON | SWSTART_F4);
    adc.bare.run_to(adc.bare.events.now() + 2'000);
    EXPECT_EQ((get(adc.block, SR) & AWD) != 0, channel != 3) << channel;
  }
}

TEST(AdcF405, DualSimultaneousPacksBothIntoOneWord) {
  F405Adc adc;
  put(adc.block, kCommon + CCR, 1u << 16 | 2u << 14 | CCR_DDS | 6);
  put(adc.block, SQR3, 1);
  put(adc.block, 0x100 + SQR3, 2);
  put(adc.block, 0x100 + CR2, ADON);
  put(adc.block, CR2, ADON | SWSTART_F4);
  adc.bare.run_to(clocks_ns(15, 21'000'000));
  EXPECT_TRUE(adc.bank.converter(1).request().level());
  EXPECT_EQ(get(adc.block, kCommon + CDR), 202u << 16 | 101u);
  EXPECT_FALSE(adc.bank.converter(1).request().level());
  EXPECT_EQ(adc.sampled[0], adc.sampled[1]);
}

TEST(AdcF405, TripleInterleavedStartsFiveClocksApart) {
  F405Adc adc;
  put(adc.block, kCommon + CCR, 1u << 16 | 23);
  for (std::uint32_t base : {0x200u, 0x100u}) put(adc.block, base + CR2, ADON | CONT);
  put(adc.block, CR2, ADON | CONT | SWSTART_F4);
  adc.bare.run_to(1'800);
  std::vector<Nanoseconds> want(6);
  for (int i = 0; i < 6; ++i) want[static_cast<std::size_t>(i)] = clocks_ns(3 + 5 * i, 21'000'000);
  ASSERT_GE(adc.sampled.size(), 6u);
  adc.sampled.resize(6);
  EXPECT_EQ(adc.sampled, want);
}

TEST(AdcF405, SensorsAnswerAsTheDataSheetSays) {
  F405Adc adc;
  put(adc.block, kCommon + CCR, 1u << 16 | TSVREFE);
  struct Row {
    std::uint32_t channel;
    double volts;
  };
  for (const Row& row : {Row{16, 0.76}, Row{17, 1.21}}) {
    put(adc.block, SQR3, row.channel);
    put(adc.block, CR2, ADON | SWSTART_F4);
    adc.bare.run_to(adc.bare.events.now() + 2'000);
    EXPECT_EQ(get(adc.block, DR), std::lround(row.volts / 3.3 * 4096));
  }
}

TEST(AdcF103, CalibrationTakes83Clocks) {
  F103Adc adc;
  Adc& one = adc.bank.converter(1);
  put(one, CR2, ADON);
  put(one, CR2, ADON | RSTCAL);
  adc.bare.run_to(1'000);
  EXPECT_EQ(get(one, CR2), ADON);
  put(one, CR2, ADON | CAL);
  adc.bare.run_to(1'000 + clocks_ns(83, 12'000'000) - 1);
  EXPECT_EQ(get(one, CR2), ADON | CAL);
  adc.bare.run_to(1'000 + clocks_ns(83, 12'000'000));
  EXPECT_EQ(get(one, CR2), ADON);
}

TEST(AdcF103, WritingAdonAgainStartsAndAnotherBitBesideItDoesNot) {
  F103Adc adc;
  Adc& one = adc.bank.converter(1);
  put(one, CR2, ADON);
  adc.bare.run_to(10'000);
  EXPECT_EQ(get(one, SR), 0u);
  put(one, CR2, ADON | ALIGN);
  adc.bare.run_to(20'000);
  EXPECT_EQ(get(one, SR), 0u);
  put(one, CR2, ADON | ALIGN);
  adc.bare.run_to(20'000 + clocks_ns(14, 12'000'000));
  EXPECT_EQ(get(one, SR), STRT | EOC);
}

TEST(AdcF103, The239Point5SettingTakes252Clocks) {
  F103Adc adc;
  Adc& one = adc.bank.converter(1);
  put(one, SMPR2, 7);
  put(one, CR2, ADON | EXTTRIG | 7u << 17);
  put(one, CR2, ADON | EXTTRIG | 7u << 17 | SWSTART_F1);
  adc.bare.run_to(21'000 - 1);  // 252 / 12 MHz
  EXPECT_EQ(get(one, SR), STRT);
  adc.bare.run_to(21'000);
  EXPECT_EQ(get(one, SR), STRT | EOC);
}

TEST(AdcF103, ASequenceIsToldFromItsStartToTheEndOfItsLastConversion) {
  F103Adc adc;
  Adc& one = adc.bank.converter(1);
  std::vector<Nanoseconds> told;
  one.on_sequence([&](Nanoseconds began, Nanoseconds ended) { told = {began, ended}; });
  const std::uint32_t by_software = ADON | JEXTTRIG | 7u << 12;
  put(one, CR1, SCAN);
  put(one, JSQR, 1u << 20 | 3u << 15 | 2u << 10);  // two channels
  put(one, CR2, by_software);
  adc.bare.run_to(1'000'000);
  put(one, CR2, by_software | JSWSTART_F1);
  adc.bare.run_to(1'000'000 + clocks_ns(28, 12'000'000) - 1);
  EXPECT_TRUE(told.empty());
  adc.bare.run_to(1'000'000 + clocks_ns(28, 12'000'000));
  EXPECT_EQ(told, (std::vector<Nanoseconds>{1'000'000, 1'000'000 + clocks_ns(28, 12'000'000)}));
}

TEST(AdcF103, DualSimultaneousShowsTheSecondConverterInTheUpperHalf) {
  F103Adc adc;
  Adc &one = adc.bank.converter(1), &two = adc.bank.converter(2);
  put(one, CR1, 6u << 16 | SCAN);
  put(two, CR1, SCAN);
  put(one, SQR1, 1u << 20);
  put(two, SQR1, 1u << 20);
  put(one, SQR3, 1 | 2 << 5);
  put(two, SQR3, 3 | 4 << 5);
  put(two, CR2, ADON | EXTTRIG | 7u << 17);
  put(one, CR2, ADON | DMA | CONT | EXTTRIG | 7u << 17);
  put(two, CR2, ADON | CONT | EXTTRIG | 7u << 17);
  std::vector<std::uint32_t> words;
  one.request().on_change([&](bool level) {
    if (level) words.push_back(get(one, DR));
  });
  put(one, CR2, ADON | DMA | CONT | EXTTRIG | 7u << 17 | SWSTART_F1);
  adc.bare.run_to(clocks_ns(3 * 14, 12'000'000) + 1);
  EXPECT_EQ(words,
            (std::vector<std::uint32_t>{302u << 16 | 101u, 402u << 16 | 201u, 302u << 16 | 101u}));
}

}  // namespace
}  // namespace whirl::stm32

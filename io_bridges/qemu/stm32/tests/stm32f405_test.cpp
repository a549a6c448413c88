// The assembly: clocks, gates, pins and one transfer on each kind of bus, as a first image does.
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t kRcc = 0x40023800, kGpioB = 0x40020400, kSpi1 = 0x40013000,
                        kUsart2 = 0x40004400, kI2c3 = 0x40005C00;

TEST(Stm32f405, ClimbsTo168MHzAsEverySystemInitDoes) {
  ChipBench bench;
  EXPECT_EQ(bench.chip().sysclk_Hz(), 16e6);  // HSI after reset
  bench.clock_168();
  EXPECT_EQ(bench.chip().sysclk_Hz(), 168e6);
  EXPECT_EQ(bench.chip().clocks().pclk1_Hz(), 42e6);
  EXPECT_EQ(bench.chip().clocks().pclk2_Hz(), 84e6);
  EXPECT_EQ(bench.chip().clocks().timclk1_Hz(), 84e6);
  EXPECT_EQ(bench.chip().clocks().timclk2_Hz(), 168e6);
  EXPECT_TRUE(bench.findings.empty()) << bench.findings.front();
}

TEST(Stm32f405, ABlockWithoutClockReadsZeroAndSaysSoOnce) {
  ChipBench bench;
  bench.put(kSpi1, 0x4);
  EXPECT_EQ(bench.get(kSpi1 + 8), 0u);  // SR is 2 when clocked
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_EQ(bench.findings[0], "SPI1: accessed with its clock off");
  bench.set_bits(kRcc + 0x44, 1u << 12);
  EXPECT_EQ(bench.get(kSpi1 + 8), 2u);
  EXPECT_EQ(bench.get(kSpi1), 0u);  // the write was lost
}

TEST(Stm32f405, BsrrDrivesAPinHalfWordsIncluded) {
  ChipBench bench;
  bench.set_bits(kRcc + 0x30, 2);
  io::Wire& pin = *bench.chip().pin("PB0");
  bench.put(kGpioB + 0x18, 1);  // ODR first, so that the pin starts high
  bench.put(kGpioB, 0x281);
  EXPECT_TRUE(pin.level());
  bench.put(kGpioB + 0x1A, 1, 2);  // BSRRH of the SPL
  EXPECT_FALSE(pin.level());
  bench.put(kGpioB + 0x18, 1, 2);  // BSRRL
  EXPECT_TRUE(pin.level());
  EXPECT_EQ(bench.get(kGpioB + 0x14), 1u);
  EXPECT_EQ(bench.chip().pin("PZ1"), nullptr);
}

struct Echo : io::SpiTarget {
  void select(bool on, Nanoseconds) override { selected = on; }
  std::uint8_t transfer(std::uint8_t mosi, std::uint32_t sck, int, Nanoseconds now) override {
    sck_Hz = sck;
    at = now;
    seen.push_back(mosi);
    return static_cast<std::uint8_t>(mosi ^ 0xFF);
  }
  bool selected = false;
  std::uint32_t sck_Hz = 0;
  Nanoseconds at = 0;
  std::vector<std::uint8_t> seen;
};

TEST(Stm32f405, APolledSpiByteTakesEightBitTimes) {
  ChipBench bench;
  bench.clock_168();
  Echo echo;
  bench.chip().spi(1)->add(echo, *bench.chip().pin("PB0"));
  bench.set_bits(kRcc + 0x30, 3);
  bench.set_bits(kRcc + 0x44, 1u << 12);
  for (int pin : {5, 6, 7}) bench.mux('A', pin, 5);
  bench.put(kGpioB + 0x18, 1);
  bench.put(kGpioB, 0x281);
  bench.put(kGpioB + 0x18, 1u << 16);
  EXPECT_TRUE(echo.selected);
  bench.put(kSpi1, 0x0354);  // SSM SSI SPE BR=2 (84 MHz / 8) MSTR, mode 0
  const Nanoseconds start = bench.now();
  bench.put(kSpi1 + 0xC, 0x75, 1);
  bench.wait(kSpi1 + 8, 1, 1);
  EXPECT_EQ(bench.get(kSpi1 + 0xC, 1), 0x8Au);
  EXPECT_EQ(echo.sck_Hz, 10'500'000u);
  EXPECT_EQ(echo.at - start, 762);      // 8 / 10.5 MHz = 761.9 ns
  EXPECT_EQ(bench.get(kSpi1 + 8), 2u);  // TXE, no longer BSY
  EXPECT_TRUE(bench.findings.empty());
}

TEST(Stm32f405, AnSpiByteWithNoPinMuxedReachesNobody) {
  ChipBench bench;
  Echo echo;
  bench.chip().spi(1)->add(echo, *bench.chip().pin("PB0"));
  bench.set_bits(kRcc + 0x44, 1u << 12);
  bench.put(kSpi1, 0x0354);
  bench.put(kSpi1 + 0xC, 0x75, 1);
  bench.run(100'000);
  EXPECT_TRUE(echo.seen.empty());
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_EQ(bench.findings[0], "SPI1: transfer with no pin muxed to SCK");
}

struct Ear : io::UartPeer {
  void receive(const io::UartByte& byte, const io::UartFormat& f, Nanoseconds now) override {
    heard.push_back(byte.value);
    at.push_back(now);
    format = f;
  }
  using UartPeer::send;
  std::vector<std::uint8_t> heard;
  std::vector<Nanoseconds> at;
  io::UartFormat format;
};

TEST(Stm32f405, UsartBytesArePacedByBrr) {
  ChipBench bench;
  bench.clock_168();
  Ear ear;
  ASSERT_TRUE(bench.chip().join_uart(2, ear));
  bench.set_bits(kRcc + 0x40, 1u << 17);
  bench.mux('A', 2, 7);
  bench.mux('A', 3, 7);
  bench.put(kUsart2 + 8, 729);  // 42 MHz / 57600 = 729.17
  bench.put(kUsart2 + 0xC, 0x200C);
  bench.run(1'000'000);  // the idle frame of TE has passed
  const Nanoseconds start = bench.now();
  bench.put(kUsart2 + 4, 'w');
  EXPECT_EQ(bench.get(kUsart2) & 0x80, 0x80u);  // moved on to the shift register
  bench.put(kUsart2 + 4, 'h');
  EXPECT_EQ(bench.get(kUsart2) & 0x80, 0u);
  bench.run(2 * 173'572);
  EXPECT_EQ(ear.heard, (std::vector<std::uint8_t>{'w', 'h'}));
  EXPECT_EQ(ear.at[0] - start, 173'571);  // 10 bits x 729 / 42 MHz
  EXPECT_EQ(bench.get(kUsart2) & 0xC0, 0xC0u);
  ear.send({'!'}, {57600, 8, 'N', 1});
  EXPECT_EQ(bench.get(kUsart2) & 0x2F, 0x20u);
  EXPECT_EQ(bench.get(kUsart2 + 4), static_cast<std::uint32_t>('!'));
  EXPECT_EQ(bench.get(kUsart2) & 0x20, 0u);
}

struct Register : io::I2cTarget {
  bool answers(std::uint8_t a) const override { return a == 0x29; }
  bool start(std::uint8_t, bool, Nanoseconds now) override {
    events.push_back({'A', now});
    return true;
  }
  bool write(std::uint8_t byte, Nanoseconds now) override {
    events.push_back({'W', now});
    got.push_back(byte);
    return true;
  }
  std::uint8_t read(Nanoseconds) override { return next++; }
  void acked(bool ack, Nanoseconds) override { acks.push_back(ack); }
  void stop(Nanoseconds now) override { events.push_back({'P', now}); }
  struct Event {
    char what;
    Nanoseconds at;
  };
  std::vector<Event> events;
  std::vector<std::uint8_t> got;
  std::vector<bool> acks;
  std::uint8_t next = 0x10;
};

void i2c3_at_400k(ChipBench& bench) {
  bench.clock_168();
  bench.set_bits(kRcc + 0x40, 1u << 23);
  bench.mux('A', 8, 4, true);
  bench.mux('C', 9, 4, true);
  bench.put(kI2c3 + 0x04, 42);
  bench.put(kI2c3 + 0x1C, 0x8000 | 35);
  bench.put(kI2c3 + 0x20, 13);
  bench.put(kI2c3, 1);
}

TEST(Stm32f405, I2cWriteTakesNineBitTimesPerByte) {
  ChipBench bench;
  i2c3_at_400k(bench);
  Register esc;
  bench.chip().i2c(3)->add(esc);
  bench.set_bits(kI2c3, 0x100);
  bench.wait(kI2c3 + 0x14, 1, 1);
  bench.put(kI2c3 + 0x10, 0x29 << 1);
  bench.wait(kI2c3 + 0x14, 2, 2);
  EXPECT_EQ(bench.get(kI2c3 + 0x18) & 7, 7u);  // TRA BUSY MSL, and ADDR is cleared
  for (int byte : {1, 2, 3}) {
    bench.wait(kI2c3 + 0x14, 0x80, 0x80);
    bench.put(kI2c3 + 0x10, static_cast<std::uint32_t>(byte));
  }
  bench.wait(kI2c3 + 0x14, 4, 4);
  bench.set_bits(kI2c3, 0x200);
  bench.wait(kI2c3, 0x200, 0);
  EXPECT_EQ(esc.got, (std::vector<std::uint8_t>{1, 2, 3}));
  ASSERT_EQ(esc.events.size(), 5u);
  EXPECT_EQ(esc.events[2].at - esc.events[1].at, 22'500);  // 9 bits at 400 kHz
  EXPECT_EQ(esc.events[4].what, 'P');
  EXPECT_EQ(bench.get(kI2c3 + 0x18), 0u);
  EXPECT_TRUE(bench.findings.empty());
}

TEST(Stm32f405, DmaMovesAUsartBufferAndRaisesItsInterrupt) {
  ChipBench bench;
  bench.clock_168();
  Ear ear;
  bench.chip().join_uart(2, ear);
  bench.set_bits(kRcc + 0x40, 1u << 17);
  bench.set_bits(kRcc + 0x30, 1u << 21);
  bench.mux('A', 2, 7);
  constexpr std::uint32_t kStream6 = 0x40026000 + 0x10 + 6 * 0x18;
  std::memcpy(bench.ram(0x20000100), "rotor", 5);
  bench.put(kStream6 + 8, kUsart2 + 4);
  bench.put(kStream6 + 0xC, 0x20000100);
  bench.put(kStream6 + 4, 5);
  bench.put(kStream6, (4u << 25) | (1u << 10) | (1u << 6) | (1u << 4) | 1);
  bench.put(kUsart2 + 8, 729);
  bench.put(kUsart2 + 0x14, 0x80);
  bench.put(kUsart2 + 0xC, 0x2008);
  bench.run(10'000'000);
  EXPECT_EQ(std::string(ear.heard.begin(), ear.heard.end()), "rotor");
  EXPECT_TRUE(bench.irq(17));
  EXPECT_EQ(bench.get(0x40026004), (1u << 21) | (1u << 20));  // TCIF6, HTIF6
  EXPECT_EQ(bench.get(kStream6) & 1, 0u);
  bench.put(0x4002600C, 0x3Fu << 16);
  EXPECT_FALSE(bench.irq(17));
}

// Both halves of the part joined: TIM3_CH1 reaches PC6 through AF2 only, TIM2's update moves words
// by DMA, and a 5 kHz update interrupt comes every 200 us.
TEST(Stm32f405, TimerReachesItsPinThroughTheAlternateFunction) {
  ChipBench bench;
  bench.clock_168();
  constexpr std::uint32_t kTim3 = 0x40000400;
  bench.set_bits(kRcc + 0x40, 2);
  bench.put(kTim3 + 0x2C, 839);  // 84 MHz / 840 = 100 kHz
  bench.put(kTim3 + 0x34, 210);
  bench.put(kTim3 + 0x18, 0x68);  // PWM mode 1
  bench.put(kTim3 + 0x20, 1);
  bench.put(kTim3 + 0x14, 1);
  bench.mux('C', 6, 3);  // TIM8_CH1 first: the wrong one
  bench.put(kTim3, 1);
  std::vector<Nanoseconds> rises;
  bench.chip().pin("PC6")->watch([&](bool level, Nanoseconds now) {
    if (level) rises.push_back(now);
  });
  bench.run(100'000);
  EXPECT_TRUE(rises.empty());
  bench.mux('C', 6, 2);
  bench.run(100'000);
  ASSERT_GE(rises.size(), 9u);
  EXPECT_EQ(rises[5] - rises[4], 10'000);
}

TEST(Stm32f405, TimerUpdateMovesWordsToAPortByDma) {
  ChipBench bench;
  bench.clock_168();
  constexpr std::uint32_t kTim1 = 0x40010000, kStream5 = 0x40026410 + 5 * 0x18;
  bench.set_bits(kRcc + 0x30, 2 | (1u << 22));
  bench.set_bits(kRcc + 0x44, 1);
  bench.put(kGpioB, 0x281);
  const std::uint32_t pattern[4] = {1, 1u << 16, 1, 1u << 16};
  std::memcpy(bench.ram(0x20000000), pattern, sizeof pattern);
  bench.put(kStream5 + 8, kGpioB + 0x18);
  bench.put(kStream5 + 0xC, 0x20000000);
  bench.put(kStream5 + 4, 4);
  bench.put(kStream5, (6u << 25) | (2u << 13) | (2u << 11) | (1u << 10) | (1u << 6) | 1);
  bench.put(kTim1 + 0x2C, 16799);  // 100 us
  bench.put(kTim1 + 0x0C, 1u << 8);
  std::vector<Nanoseconds> edges;
  bench.chip().pin("PB0")->watch([&](bool, Nanoseconds now) { edges.push_back(now); });
  bench.put(kTim1, 1);
  bench.run(1'000'000);
  ASSERT_EQ(edges.size(), 4u);
  EXPECT_EQ(edges[3] - edges[0], 300'000);
}

TEST(Stm32f405, IndependentWatchdogResetsThePartAndCsrTellsIt) {
  ChipBench bench;
  ResetCause asked = ResetCause::pin;
  bench.chip().on_reset_request([&](ResetCause cause) { asked = cause; });
  bench.put(kRcc + 0x74, 1u << 24);
  EXPECT_EQ(bench.get(kRcc + 0x74) >> 25, 0u);
  bench.put(0x40003000, 0xCCCC);  // 4096 x 4 / 32 kHz = 512 ms after reset
  bench.run(520'000'000);
  ASSERT_EQ(asked, ResetCause::independent_watchdog);
  bench.chip().reset(asked);
  EXPECT_EQ(bench.get(kRcc + 0x74) & 0xFE000000, (1u << 29) | (1u << 26));  // IWDG, NRST pin
}

}  // namespace
}  // namespace whirl::stm32

// The STM32F103 (RM0008, PM0075): what differs from the F405, and the ESC's buses on its pins.
#include "io_bridges/qemu/stm32/stm32f103.hpp"
#include "base/near.hpp"
#include "io_bridges/devices/i2c_master.hpp"
#include "io_bridges/qemu/stm32/bxcan.hpp"
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"
#include "io_bridges/qemu/stm32/timer.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t kRcc = 0x40021000, kCfgr = kRcc + 4, kAhbEnr = kRcc + 0x14,
                        kApb2Enr = kRcc + 0x18, kApb1Enr = kRcc + 0x1C, kCsr = kRcc + 0x24,
                        kGpioA = 0x40010800, kGpioB = 0x40010C00, kAfio = 0x40010000,
                        kExti = 0x40010400, kFlash = 0x40022000, kDma = 0x40020000,
                        kUsart1 = 0x40013800, kI2c2 = 0x40005800;

struct F103Bench : ChipBench {
  F103Bench() : ChipBench(8e6, make_stm32f103) {}
  // 8 MHz x 9, PCLK1 / 2: SetSysClockTo72 of every F1 project.
  void clock_72() {
    set_bits(kRcc, 1u << 16);
    wait(kRcc, 1u << 17, 1u << 17);
    put(kFlash, 0x12);
    set_bits(kCfgr, (4u << 8) | (7u << 18) | (1u << 16));
    set_bits(kRcc, 1u << 24);
    wait(kRcc, 1u << 25, 1u << 25);
    set_bits(kCfgr, 2);
    wait(kCfgr, 0xC, 8);
    put(kApb2Enr, 0xFFFFF);
    put(kApb1Enr, 0x3FFFFFFF);
    set_bits(kAhbEnr, 0x41);
  }
  void configure(std::uint32_t port, int pin, std::uint32_t field) {
    const std::uint32_t reg = port + 4u * static_cast<std::uint32_t>(pin / 8);
    put(reg, (get(reg) & ~(0xFu << (4 * (pin % 8)))) | (field << (4 * (pin % 8))));
  }
};
constexpr std::uint32_t kAfPushPull = 0xB, kAfOpenDrain = 0xF, kOutput = 0x3, kFloating = 0x4,
                        kPulled = 0x8;

TEST(Stm32f103, ClimbsTo72MHz) {
  F103Bench bench;
  EXPECT_EQ(bench.chip().sysclk_Hz(), 8e6);
  bench.clock_72();
  EXPECT_EQ(bench.chip().sysclk_Hz(), 72e6);
  EXPECT_EQ(bench.chip().clocks().pclk1_Hz(), 36e6);
  EXPECT_EQ(bench.chip().clocks().pclk2_Hz(), 72e6);
  EXPECT_EQ(bench.chip().clocks().timclk1_Hz(), 72e6);
  EXPECT_TRUE(bench.findings.empty()) << bench.findings.front();
  EXPECT_EQ(bench.get(kCsr), 0x0C000000u);
}

TEST(Stm32f103, HalfHsiTimesSixteenIs64MHz) {
  F103Bench bench;
  bench.put(kFlash, 0x12);
  bench.put(kCfgr, (15u << 18) | (4u << 8));
  bench.set_bits(kRcc, 1u << 24);
  bench.run(300'000);
  bench.set_bits(kCfgr, 2);
  EXPECT_EQ(bench.chip().sysclk_Hz(), 64e6);
}

TEST(Stm32f103, PinsAreFloatingInputsAndPullWithOdr) {
  F103Bench bench;
  bench.clock_72();
  EXPECT_EQ(bench.get(kGpioA), 0x44444444u);
  io::Wire& pin = *bench.chip().pin("PA0");
  bench.configure(kGpioA, 0, kPulled);
  EXPECT_FALSE(pin.level());
  bench.put(kGpioA + 0x10, 1);
  EXPECT_TRUE(pin.level());
  bench.configure(kGpioA, 0, kOutput);
  bench.put(kGpioA + 0x14, 1);  // BRR
  EXPECT_FALSE(pin.level());
  EXPECT_EQ(bench.get(kGpioA + 8) & 1, 0u);
}

struct Far : io::UartPeer {
  void receive(const io::UartByte& byte, const io::UartFormat&, Nanoseconds now) override {
    bytes.push_back(byte.value);
    at.push_back(now);
  }
  using UartPeer::send;
  std::vector<std::uint8_t> bytes;
  std::vector<Nanoseconds> at;
};

TEST(Stm32f103, UsartOneMovesToPortBByRemap) {
  F103Bench bench;
  bench.clock_72();
  Far far;
  bench.chip().join_uart(1, far);
  bench.configure(kGpioA, 9, kAfPushPull);
  bench.configure(kGpioA, 10, kFloating);
  bench.put(kUsart1 + 8, 625);  // 115200 at 72 MHz
  bench.put(kUsart1 + 0xC, 0x200C);
  bench.run(1'000'000);
  bench.put(kUsart1 + 4, 'a');
  bench.put(kUsart1 + 4, 'b');
  bench.run(1'000'000);
  ASSERT_EQ(far.bytes.size(), 2u);
  EXPECT_EQ(far.at[1] - far.at[0], 86'806);
  far.send({'x'}, {115200, 8, 'N', 1});  // RX is heard in input mode
  EXPECT_EQ(bench.get(kUsart1 + 4), static_cast<std::uint32_t>('x'));
  bench.put(kAfio + 4, 4);  // USART1_REMAP: PB6, PB7
  bench.put(kUsart1 + 4, 'c');
  bench.run(1'000'000);
  EXPECT_EQ(far.bytes.size(), 2u);
  bench.configure(kGpioB, 6, kAfPushPull);
  bench.put(kUsart1 + 4, 'd');
  bench.run(1'000'000);
  EXPECT_EQ(far.bytes.back(), 'd');
}

TEST(Stm32f103, AUartPinLeftAsInputSendsNothing) {
  F103Bench bench;
  bench.clock_72();
  Far far;
  bench.chip().join_uart(1, far);
  bench.put(kUsart1 + 8, 625);
  bench.put(kUsart1 + 0xC, 0x200C);
  bench.put(kUsart1 + 4, 'a');
  bench.run(1'000'000);
  EXPECT_TRUE(far.bytes.empty());
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_EQ(bench.findings[0], "USART1: sending with no pin muxed to TX");
}

// The ESC: I2C2 on PB10, PB11 as a slave at 0x29, interrupts, an external 400 kHz master.
TEST(Stm32f103, IsAnI2cSlaveOnPb10AndPb11) {
  F103Bench bench;
  bench.clock_72();
  bench.configure(kGpioB, 10, kAfOpenDrain);
  bench.configure(kGpioB, 11, kAfOpenDrain);
  bench.put(kI2c2 + 4, 36 | 0x0700);
  bench.put(kI2c2 + 8, 0x4000 | (0x29 << 1));
  bench.put(kI2c2, 1);
  bench.set_bits(kI2c2, 0x400);
  std::vector<std::uint8_t> got;
  int stops = 0, naks = 0;
  const auto service = [&] {  // an interrupt handler, 2 us after its line
    const std::uint32_t sr1 = bench.get(kI2c2 + 0x14);
    if ((sr1 & 2) != 0) bench.get(kI2c2 + 0x18);
    if ((sr1 & 0x40) != 0) got.push_back(static_cast<std::uint8_t>(bench.get(kI2c2 + 0x10)));
    if ((sr1 & 0x80) != 0) bench.put(kI2c2 + 0x10, 0xC0u + got.size());
    if ((sr1 & 0x10) != 0) {
      bench.set_bits(kI2c2, 1);
      ++stops;
    }
    if ((sr1 & 0x400) != 0) {
      bench.put(kI2c2 + 0x14, 0xFBFF);
      ++naks;
    }
  };
  io::I2cMaster master(bench.events(), *bench.chip().i2c(2), 400e3);
  io::I2cReply write, read;
  master.transfer({0x29, {0x40, 0x01, 0x7A}, 0}, [&](const io::I2cReply& r) { write = r; });
  const auto run = [&] {
    for (int i = 0; i < 200; ++i) {
      bench.run(2'000);
      if (bench.irq(33) || bench.irq(34)) service();
    }
  };
  run();
  EXPECT_TRUE(write.acked);
  EXPECT_EQ(got, (std::vector<std::uint8_t>{0x40, 0x01, 0x7A}));
  EXPECT_EQ(stops, 1);
  master.transfer({0x29, {}, 2}, [&](const io::I2cReply& r) { read = r; });
  run();
  EXPECT_EQ(read.bytes, (std::vector<std::uint8_t>{0xC3, 0xC3}));
  EXPECT_EQ(naks, 1);
  EXPECT_LT(read.stretched_ns, 10'000);
}

// PB6 as TIM4's push-pull output is not on I2C1's wire, though I2C1 has no remap.
TEST(Stm32f103, PushPullPwmDoesNotJoinTheI2cNet) {
  F103Bench bench;
  bench.clock_72();
  bench.put(0x40000800 + 0x2C, 3599);  // TIM4: 20 kHz
  bench.put(0x40000800 + 0x34, 900);
  bench.put(0x40000800 + 0x18, 0x68);
  bench.put(0x40000800 + 0x20, 1);
  bench.configure(kGpioB, 6, kAfPushPull);
  bench.put(0x40000800, 1);
  int rises = 0;
  bench.chip().pin("PB6")->watch([&](bool level, Nanoseconds) { rises += level ? 1 : 0; });
  bench.run(1'000'000);
  EXPECT_TRUE(near(rises, 20, stated(1, "where the millisecond begins")));
  EXPECT_TRUE(bench.chip().i2c(1)->idle());
}

TEST(Stm32f103, ExtiTakesItsPortFromAfio) {
  F103Bench bench;
  bench.clock_72();
  io::Wire& pin = *bench.chip().pin("PB12");
  const int board = pin.add_driver();
  pin.drive(board, io::Drive::low, 0);
  bench.put(kAfio + 0x14, 1);
  bench.put(kExti, 1u << 12);
  bench.put(kExti + 8, 1u << 12);
  pin.drive(board, io::Drive::high, 0);
  EXPECT_TRUE(bench.irq(40));
  bench.put(kExti + 0x14, 1u << 12);
  EXPECT_FALSE(bench.irq(40));
}

TEST(Stm32f103, DmaChannelStaysEnabledAtItsEnd) {
  F103Bench bench;
  bench.clock_72();
  Far far;
  bench.chip().join_uart(1, far);
  bench.configure(kGpioA, 9, kAfPushPull);
  bench.put(kUsart1 + 8, 625);
  bench.put(kUsart1 + 0xC, 0x2008);
  std::memcpy(bench.ram(0x20000000), "esc", 3);
  constexpr std::uint32_t kChannel4 = kDma + 8 + 3 * 0x14;
  bench.put(kChannel4 + 4, 3);
  bench.put(kChannel4 + 8, kUsart1 + 4);
  bench.put(kChannel4 + 0xC, 0x20000000);
  bench.put(kChannel4, 0x93);  // MINC DIR TCIE EN
  bench.put(kUsart1 + 0x14, 0x80);
  bench.run(2'000'000);
  EXPECT_EQ(std::string(far.bytes.begin(), far.bytes.end()), "esc");
  EXPECT_TRUE(bench.irq(14));
  EXPECT_EQ(bench.get(kDma), 0x7u << 12);  // GIF TCIF HTIF
  EXPECT_EQ(bench.get(kChannel4) & 1, 1u);
  bench.put(kDma + 4, 0x1u << 12);  // CGIF clears all of them
  EXPECT_EQ(bench.get(kDma), 0u);
  EXPECT_FALSE(bench.irq(14));
}

TEST(Stm32f103, DmaConvertsSizesByExtensionAndTruncation) {
  F103Bench bench;
  bench.clock_72();
  for (std::uint32_t i = 0; i < 4; ++i)
    *bench.ram(0x20000000 + i) = static_cast<std::uint8_t>(0xA0 + i);
  constexpr std::uint32_t kChannel1 = kDma + 8;
  bench.put(kChannel1 + 4, 4);
  bench.put(kChannel1 + 8, 0x20000000);
  bench.put(kChannel1 + 0xC, 0x20000100);
  bench.put(kChannel1, 0x4000 | (1u << 10) | 0xC1);  // bytes to half-words
  bench.run(100'000);
  EXPECT_EQ(std::memcmp(bench.ram(0x20000100), "\xA0\0\xA1\0\xA2\0\xA3\0", 8), 0);
}

TEST(Stm32f103, FlashErasesPagesAndProgramsHalfWords) {
  F103Bench bench;
  std::fill(bench.flash().begin(), bench.flash().end(), 0);
  EXPECT_FALSE(bench.chip().flash_store(0x0801FC00, 2, 0x1234));  // locked: bus fault
  bench.put(kFlash + 4, 0x45670123);
  bench.put(kFlash + 4, 0xCDEF89AB);
  EXPECT_EQ(bench.get(kFlash + 0x10), 0u);
  bench.put(kFlash + 0x10, 2);
  bench.put(kFlash + 0x14, 0x0801FC04);
  bench.set_bits(kFlash + 0x10, 0x40);
  EXPECT_EQ(bench.get(kFlash + 0xC) & 1, 1u);
  bench.wait(kFlash + 0xC, 1, 0);
  EXPECT_EQ(bench.get(kFlash + 0xC), 0x20u);  // EOP
  EXPECT_EQ(bench.flash()[0x1FBFF], 0);
  EXPECT_EQ(bench.flash()[0x1FC00], 0xFF);
  EXPECT_EQ(bench.flash()[0x1FFFF], 0xFF);
  bench.put(kFlash + 0x10, 1);
  EXPECT_FALSE(bench.chip().flash_store(0x0801FC00, 4, 0));  // words are refused
  EXPECT_TRUE(bench.chip().flash_store(0x0801FC00, 2, 0xBEEF));
  const Nanoseconds t = bench.now();
  EXPECT_TRUE(near(static_cast<double>(bench.wait(kFlash + 0xC, 1, 0) - t), 52'500.0,
                   stated(100.0, "the bench polls")));
  EXPECT_EQ(bench.flash()[0x1FC01], 0xBE);
  bench.put(kFlash + 0xC, 0x20);
  EXPECT_TRUE(bench.chip().flash_store(0x0801FC00, 2, 0x1111));
  EXPECT_EQ(bench.get(kFlash + 0xC), 4u);  // PGERR: not erased
  EXPECT_EQ(bench.flash()[0x1FC01], 0xBE);
}

TEST(Stm32f103, JtagPinsMustBeFreedFirst) {
  F103Bench bench;
  bench.clock_72();
  bench.configure(kGpioB, 4, kOutput);
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_EQ(bench.findings[0], "AFIO: PB4 is an output while SWJ_CFG leaves it to JTAG");
  F103Bench freed;
  freed.clock_72();
  freed.put(kAfio + 4, 2u << 24);
  freed.configure(kGpioB, 4, kOutput);
  freed.configure(kGpioB, 3, kOutput);
  EXPECT_TRUE(freed.findings.empty());
}

// What a power stage sees of TIM4 CH1 (PB6): 20 kHz of 72 MHz, a quarter on, and the pin with it.
TEST(Stm32f103, APowerStageHearsThePatternAndThePinShowsIt) {
  constexpr std::uint32_t kTim4 = 0x40000800;
  F103Bench bench;
  bench.clock_72();
  bench.configure(kGpioB, 6, kAfPushPull);
  ASSERT_NE(bench.chip().timer(4), nullptr);
  EXPECT_EQ(bench.chip().timer(5), nullptr);
  EXPECT_NE(bench.chip().can(1), nullptr);
  std::vector<PwmPattern> heard;
  bench.chip().timer(4)->observe_pwm([&](const PwmPattern& pattern) { heard.push_back(pattern); });
  bench.put(kTim4 + 0x2C, 3599);
  bench.put(kTim4 + 0x34, 900);
  bench.put(kTim4 + 0x18, 0x68);
  bench.put(kTim4 + 0x20, 1);
  bench.put(kTim4 + 0x14, 1);
  bench.put(kTim4, 0x81);
  bench.run(49'000);
  ASSERT_FALSE(heard.empty());
  EXPECT_TRUE(heard.back().counting);
  EXPECT_TRUE(near(heard.back().period_s, 50e-6, round_off(4, 50e-6)));
  EXPECT_TRUE(near(heard.back().channel[0].duty, 0.25, round_off(4, 0.25)));
  EXPECT_TRUE(heard.back().channel[0].driven);
  EXPECT_FALSE(heard.back().channel[1].driven);
  const std::size_t before = heard.size();
  bench.run(5'000);  // 4 us into the next period
  EXPECT_TRUE(bench.chip().pin("PB6")->level());
  bench.run(15'000);
  EXPECT_FALSE(bench.chip().pin("PB6")->level());
  EXPECT_EQ(heard.size(), before);  // edges are no news
}

}  // namespace
}  // namespace whirl::stm32

// RCC, PWR, GPIO, EXTI and FLASH of an F405 (RM0090 chapters 3, 5, 7, 8, 12).
#include "base/near.hpp"
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t kRcc = 0x40023800, kCr = kRcc, kCfgr = kRcc + 8, kCir = kRcc + 0xC,
                        kBdcr = kRcc + 0x70, kCsr = kRcc + 0x74, kPwr = 0x40007000,
                        kGpioA = 0x40020000, kGpioC = 0x40020800, kSyscfg = 0x40013800,
                        kExti = 0x40013C00, kFlash = 0x40023C00;

TEST(Rcc, ReadyFlagsComeAfterTheirStartUpTimes) {
  ChipBench bench;
  EXPECT_EQ(bench.get(kCr) & 3, 3u);
  EXPECT_EQ(bench.get(kRcc + 4), 0x24003010u);
  bench.set_bits(kCr, 1u << 16);
  EXPECT_EQ(bench.wait(kCr, 1u << 17, 1u << 17), 2'000'000);  // datasheet: 2 ms typical
  const Nanoseconds t = bench.now();
  bench.set_bits(kCr, 1u << 24);
  EXPECT_EQ(bench.wait(kCr, 1u << 25, 1u << 25) - t, 200'000);
  bench.clear_bits(kCr, 1u << 24);
  EXPECT_EQ(bench.get(kCr) & (1u << 25), 0u);
}

TEST(Rcc, WithoutACrystalHseNeverComes) {
  ChipBench bench(0.0);
  bench.set_bits(kCr, 1u << 16);
  bench.run(1'000'000'000);
  EXPECT_EQ(bench.get(kCr) & (1u << 17), 0u);
}

TEST(Rcc, SwsFollowsOnlyAReadySourceAndWhatDrivesSysclkStaysOn) {
  ChipBench bench(24e6);
  bench.put(kCfgr, 1);
  EXPECT_EQ(bench.get(kCfgr) & 0xC, 0u);
  bench.set_bits(kCr, 1u << 16);
  bench.run(3'000'000);
  EXPECT_EQ(bench.get(kCfgr) & 0xC, 4u);
  EXPECT_EQ(bench.chip().sysclk_Hz(), 24e6);
  bench.clear_bits(kCr, 1u << 16);
  EXPECT_EQ(bench.get(kCr) & (1u << 16), 1u << 16);
  bench.clear_bits(kCr, 1);  // HSI is free to go
  EXPECT_EQ(bench.get(kCr) & 3, 0u);
}

std::unique_ptr<ChipModel> make_off(const ChipHost& host) {
  ChipHost off = host;
  off.hsi_error = -0.04;
  off.hse_error = 900e-6;
  return make_stm32f405(off);
}

// What the firmware sets up is as right as ever, so nobody complains; all that is clocked is off.
TEST(Rcc, AnOscillatorThatIsOffTakesAllClocksAlong) {
  ChipBench bench(8e6, make_off);
  const Clocks& clocks = bench.chip().clocks();
  EXPECT_TRUE(near(clocks.hclk_Hz(), 16e6 * 0.96, round_off(4, 16e6 * 0.96)));
  bench.clock_168();
  EXPECT_TRUE(near(bench.chip().sysclk_Hz(), 168e6 * 1.0009, round_off(4, 168e6 * 1.0009)));
  EXPECT_TRUE(near(clocks.pclk1_Hz(), 42e6 * 1.0009, round_off(4, 42e6 * 1.0009)));
  EXPECT_TRUE(near(clocks.timclk2_Hz(), 168e6 * 1.0009, round_off(4, 168e6 * 1.0009)));
  EXPECT_TRUE(bench.findings.empty()) << bench.findings[0];
}

TEST(Rcc, PrescalersDivideAsTheirTablesSay) {
  ChipBench bench;
  struct Row {
    std::uint32_t hpre;
    double divisor;
  };
  for (const Row& r : {Row{7, 1}, Row{8, 2}, Row{11, 16}, Row{12, 64}, Row{15, 512}}) {
    bench.put(kCfgr, r.hpre << 4);
    EXPECT_EQ(bench.chip().clocks().hclk_Hz(), 16e6 / r.divisor);
    EXPECT_EQ(bench.chip().clocks().timclk1_Hz(), 16e6 / r.divisor);  // not doubled: PPRE1 is 1
    EXPECT_EQ(bench.chip().clocks().timclk2_Hz(), 16e6 / r.divisor);
  }
  bench.put(kCfgr, (7u << 10) | (4u << 13));
  EXPECT_EQ(bench.chip().clocks().pclk1_Hz(), 1e6);
  EXPECT_EQ(bench.chip().clocks().timclk1_Hz(), 2e6);
  EXPECT_EQ(bench.chip().clocks().pclk2_Hz(), 8e6);
  EXPECT_EQ(bench.chip().clocks().timclk2_Hz(), 16e6);
}

TEST(Rcc, OutOfRangePllIsAFinding) {
  ChipBench bench;
  bench.put(kRcc + 4, 2 | (336u << 6));  // 16 MHz / 2 = 8 MHz into the PLL
  bench.set_bits(kCr, 1u << 24);
  ASSERT_EQ(bench.findings.size(), 2u);
  EXPECT_EQ(bench.findings[0], "RCC: PLL input outside 1 to 2 MHz");
}

TEST(Rcc, ReadyInterruptIsFlaggedAndCleared) {
  ChipBench bench;
  bench.put(kCir, 1u << 8);  // LSIRDYIE
  bench.set_bits(kCsr, 1);
  bench.run(100'000);
  EXPECT_EQ(bench.get(kCsr) & 2, 2u);
  EXPECT_TRUE(bench.irq(5));
  bench.put(kCir, (1u << 8) | (1u << 16));
  EXPECT_FALSE(bench.irq(5));
}

TEST(Rcc, ResetCausesAddUpUntilRmvf) {
  ChipBench bench;
  EXPECT_EQ(bench.get(kCsr), 0x0E000000u);  // power-on
  bench.put(kCsr, 1u << 24);
  EXPECT_EQ(bench.get(kCsr), 0u);
  bench.chip().reset(ResetCause::software);
  EXPECT_EQ(bench.get(kCsr), 0x14000000u);
  bench.chip().reset(ResetCause::window_watchdog);
  EXPECT_EQ(bench.get(kCsr), 0x54000000u);
}

TEST(Rcc, BackupDomainNeedsDbpAndOutlivesReset) {
  ChipBench bench;
  bench.put(kBdcr, 1);
  EXPECT_EQ(bench.get(kBdcr), 0u);
  bench.set_bits(kRcc + 0x40, 1u << 28);
  bench.set_bits(kPwr, 0x100);
  bench.put(kBdcr, 1);
  EXPECT_EQ(bench.wait(kBdcr, 2, 2, 3'000'000'000, 10'000), 2'000'000'000);  // LSE: 2 s
  bench.put(kBdcr, 0x8101);
  bench.put(kBdcr, 0x8201);  // RTCSEL is chosen once
  EXPECT_EQ(bench.get(kBdcr), 0x8103u);
  bench.set_bits(kRcc + 0x30, 1u << 18);
  bench.put(0x40024010, 0xCAFE);
  bench.chip().reset(ResetCause::software);
  EXPECT_EQ(bench.get(kBdcr), 0x8103u);
  bench.set_bits(kRcc + 0x30, 1u << 18);
  EXPECT_EQ(bench.get(0x40024010), 0xCAFEu);
  bench.put(0x40024010, 1);  // DBP is off again
  EXPECT_EQ(bench.get(0x40024010), 0xCAFEu);
}

TEST(Rcc, ABlockHeldInResetForgetsItsRegisters) {
  ChipBench bench;
  bench.set_bits(kRcc + 0x40, 1u << 17);
  bench.put(0x40004408, 365);
  bench.put(kRcc + 0x20, 1u << 17);
  bench.put(0x40004408, 99);
  bench.put(kRcc + 0x20, 0);
  EXPECT_EQ(bench.get(0x40004408), 0u);
}

TEST(Pwr, VosIsReadyAndTheDetectorSeesNoDip) {
  ChipBench bench;
  bench.set_bits(kRcc + 0x40, 1u << 28);
  EXPECT_EQ(bench.get(kPwr), 0x4000u);
  EXPECT_EQ(bench.get(kPwr + 4) & (1u << 14), 1u << 14);
  bench.put(kPwr, 0x40F0);  // PVDE, 2.7 V
  EXPECT_EQ(bench.get(kPwr + 4) & 4, 0u);
}

TEST(Rcc, WhatABoardWithoutSupplyRunsFromIsNotTold) {
  ChipBench bench;
  bench.chip().set_vdd(0.0);
  bench.chip().reset(ResetCause::pin);
  bench.run(300'000'000);
  EXPECT_TRUE(bench.findings.empty());
  bench.chip().set_vdd(3.3);
  bench.chip().reset(ResetCause::power_on);
  bench.run(300'000'000);
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_NE(bench.findings[0].find("still runs from its reset clock"), std::string::npos);
}

TEST(Pwr, ADipBelowTheThresholdShowsInPvdoAndOnExtiLine16) {
  ChipBench bench;
  bench.set_bits(kRcc + 0x40, 1u << 28);
  bench.put(kPwr, 0x40F0);  // PVDE, 2.7 V
  bench.put(kExti, 1u << 16);
  bench.put(kExti + 8, 1u << 16);  // rising: VDD falls below
  bench.chip().set_vdd(2.9);
  EXPECT_FALSE(bench.irq(1));
  bench.chip().set_vdd(2.5);
  EXPECT_EQ(bench.get(kPwr + 4) & 4, 4u);
  EXPECT_TRUE(bench.irq(1));
  bench.chip().set_vdd(3.3);
  EXPECT_EQ(bench.get(kPwr + 4) & 4, 0u);
}

struct PinBench : ChipBench {
  PinBench() {
    set_bits(kRcc + 0x30, 0x1FF);
    set_bits(kRcc + 0x44, 1u << 14);
  }
  void mode(std::uint32_t port, int pin, std::uint32_t m) {
    put(port, (get(port) & ~(3u << (2 * pin))) | (m << (2 * pin)));
  }
};

TEST(Gpio, ResetValuesAreThoseOfTheManual) {
  PinBench bench;
  EXPECT_EQ(bench.get(kGpioA), 0xA8000000u);
  EXPECT_EQ(bench.get(kGpioA + 0xC), 0x64000000u);
  EXPECT_EQ(bench.get(0x40020400), 0x280u);
  EXPECT_EQ(bench.get(0x4002040C), 0x100u);
  EXPECT_EQ(bench.get(kGpioC), 0u);
}

TEST(Gpio, PullsAndOpenDrainGiveWayToTheBoard) {
  PinBench bench;
  io::Wire& pin = *bench.chip().pin("PC3");
  bench.put(kGpioC + 0xC, 2u << 6);  // pull-down
  EXPECT_EQ(bench.get(kGpioC + 0x10) & 8, 0u);
  bench.put(kGpioC + 0xC, 1u << 6);  // pull-up
  EXPECT_EQ(bench.get(kGpioC + 0x10) & 8, 8u);
  bench.put(kGpioC + 4, 8);
  bench.mode(kGpioC, 3, 1);
  EXPECT_FALSE(pin.level());  // ODR 0, open drain
  bench.put(kGpioC + 0x18, 8);
  EXPECT_TRUE(pin.level());  // by the pull-up
  const int board = pin.add_driver();
  pin.drive(board, io::Drive::low, 0);
  EXPECT_EQ(bench.get(kGpioC + 0x10) & 8, 0u);
  EXPECT_EQ(pin.fights(), 0u);
}

// An idle USART drives its TX high; through an open-drain pin that is no drive at all.
TEST(Gpio, OpenDrainAppliesToAlternateFunctionsToo) {
  for (const bool open_drain : {true, false}) {
    PinBench bench;
    bench.set_bits(kRcc + 0x40, 1u << 17);
    io::Wire& pin = *bench.chip().pin("PA2");
    pin.drive(pin.add_driver(), io::Drive::low, 0);
    bench.mux('A', 2, 7, open_drain);
    bench.put(0x4000440C, 0x2008);
    EXPECT_EQ(pin.fights(), open_drain ? 0u : 1u);
  }
}

TEST(Gpio, AnalogPinsReadZero) {
  PinBench bench;
  bench.put(kGpioC + 0xC, 1u << 6);
  bench.mode(kGpioC, 3, 3);
  EXPECT_EQ(bench.get(kGpioC + 0x10) & 8, 0u);
}

TEST(Gpio, LockSequenceFreezesTheConfigurationOfItsPins) {
  PinBench bench;
  bench.put(kGpioC + 0x1C, 0x10008);
  bench.put(kGpioC + 0x1C, 0x00008);
  bench.put(kGpioC + 0x1C, 0x10008);
  EXPECT_EQ(bench.get(kGpioC + 0x1C), 0x10008u);
  bench.put(kGpioC, 0xFFFFFFFF);
  EXPECT_EQ(bench.get(kGpioC), 0xFFFFFF3Fu);
  bench.put(kGpioC + 0x18, 8);
  EXPECT_EQ(bench.get(kGpioC + 0x14), 8u);  // the data is free
}

TEST(Gpio, ABrokenLockSequenceLocksNothing) {
  PinBench bench;
  bench.put(kGpioC + 0x1C, 0x10008);
  bench.put(kGpioC + 0x1C, 0x00009);
  bench.put(kGpioC + 0x1C, 0x10008);
  EXPECT_EQ(bench.get(kGpioC + 0x1C) & 0x10000, 0u);
}

TEST(Exti, EdgesOfTheSelectedPortPendAndShareTheirInterrupts) {
  PinBench bench;
  io::Wire& pin = *bench.chip().pin("PC5");
  const int board = pin.add_driver();
  pin.drive(board, io::Drive::low, 0);
  bench.put(kSyscfg + 0xC, 2u << 4);  // EXTI5 = port C
  bench.put(kExti + 8, 1u << 5);      // rising
  pin.drive(board, io::Drive::high, 0);
  EXPECT_EQ(bench.get(kExti + 0x14), 1u << 5);
  EXPECT_FALSE(bench.irq(23));  // masked
  bench.put(kExti, 1u << 5);
  EXPECT_TRUE(bench.irq(23));
  bench.put(kExti + 0x14, 1u << 5);
  EXPECT_FALSE(bench.irq(23));
  pin.drive(board, io::Drive::low, 0);
  EXPECT_EQ(bench.get(kExti + 0x14), 0u);  // falling was not asked for
  bench.put(kExti + 0xC, 1u << 5);
  pin.drive(board, io::Drive::high, 0);
  bench.put(kExti + 0x14, 1u << 5);
  pin.drive(board, io::Drive::low, 0);
  EXPECT_TRUE(bench.irq(23));
  io::Wire& other = *bench.chip().pin("PA5");
  bench.put(kExti + 0x14, 1u << 5);
  const int other_board = other.add_driver();
  other.drive(other_board, io::Drive::low, 0);
  other.drive(other_board, io::Drive::high, 0);
  EXPECT_EQ(bench.get(kExti + 0x14), 0u);
}

TEST(Exti, SoftwareInterruptsWorkOnUnmaskedLines) {
  PinBench bench;
  bench.put(kExti + 0x10, 1u << 3);
  EXPECT_EQ(bench.get(kExti + 0x14), 0u);
  bench.put(kExti + 0x14, 1u << 3);  // takes SWIER back
  bench.put(kExti, 1u << 3);
  bench.put(kExti + 0x10, 1u << 3);
  EXPECT_TRUE(bench.irq(9));
  bench.put(kExti + 0x14, 1u << 3);
  EXPECT_EQ(bench.get(kExti + 0x10), 0u);
  EXPECT_FALSE(bench.irq(9));
}

void unlock(ChipBench& bench) {
  bench.put(kFlash + 4, 0x45670123);
  bench.put(kFlash + 4, 0xCDEF89AB);
}

TEST(Flash, WrongKeysLockUntilReset) {
  ChipBench bench;
  bench.put(kFlash + 4, 0x45670123);
  bench.put(kFlash + 4, 0x12345678);
  unlock(bench);
  EXPECT_EQ(bench.get(kFlash + 0x10), 0x80000000u);
  bench.chip().reset(ResetCause::software);
  unlock(bench);
  EXPECT_EQ(bench.get(kFlash + 0x10), 0u);
  bench.put(kFlash + 0x10, 0x80000000);
  EXPECT_EQ(bench.get(kFlash + 0x10), 0x80000000u);
}

TEST(Flash, ErasesASectorAndProgramsAWord) {
  ChipBench bench;
  std::fill(bench.flash().begin(), bench.flash().end(), 0);
  unlock(bench);
  bench.put(kFlash + 0x10, 0x200 | (5u << 3) | 2 | (1u << 24));  // x32, sector 5, SER, EOPIE
  bench.set_bits(kFlash + 0x10, 1u << 16);
  EXPECT_EQ(bench.get(kFlash + 0xC), 1u << 16);
  const Nanoseconds t = bench.now();
  EXPECT_EQ(bench.wait(kFlash + 0xC, 1u << 16, 0, 3'000'000'000, 10'000) - t,
            1'000'000'000);  // 128 KiB
  EXPECT_TRUE(bench.irq(4));
  EXPECT_EQ(bench.flash()[0x1FFFF], 0);
  EXPECT_EQ(bench.flash()[0x20000], 0xFF);
  EXPECT_EQ(bench.flash()[0x3FFFF], 0xFF);
  EXPECT_EQ(bench.flash()[0x40000], 0);
  bench.put(kFlash + 0xC, 1);
  EXPECT_FALSE(bench.irq(4));
  bench.put(kFlash + 0x10, 0x201);
  EXPECT_TRUE(bench.chip().flash_store(0x08020004, 4, 0x12345678));
  EXPECT_EQ(bench.wait(kFlash + 0xC, 1u << 16, 0) - t - 1'000'000'000, 16'000);
  EXPECT_EQ(bench.flash()[0x20004], 0x78);
  EXPECT_EQ(bench.get(kFlash + 0xC), 0u);  // no EOP without EOPIE
}

TEST(Flash, RefusesWhatTheManualRefuses) {
  ChipBench bench;
  const auto sr = [&] { return bench.get(kFlash + 0xC); };
  bench.chip().flash_store(0x08020000, 4, 0);
  EXPECT_EQ(sr(), 0x80u);  // PGSERR: locked, no PG
  bench.put(kFlash + 0xC, 0xF0);
  unlock(bench);
  bench.put(kFlash + 0x10, 0x101);  // x16
  bench.chip().flash_store(0x08020000, 4, 0);
  EXPECT_EQ(sr(), 0x40u);  // PGPERR
  bench.put(kFlash + 0xC, 0xF0);
  bench.put(kFlash + 8, 0x08192A3B);
  bench.put(kFlash + 8, 0x4C5D6E7F);
  bench.put(kFlash + 0x14, 0x0FDFAAEC);  // nWRP of sector 5
  bench.chip().flash_store(0x08020000, 2, 0);
  EXPECT_EQ(sr(), 0x10u);  // WRPERR
  EXPECT_EQ(bench.flash()[0x20000], 0xFF);
}

TEST(Flash, TooFewWaitStatesAreAFinding) {
  ChipBench bench;
  bench.put(kRcc + 4, 16 | (336u << 6) | (7u << 24));
  bench.set_bits(kCr, 1u << 24);
  bench.run(300'000);
  bench.put(kCfgr, (5u << 10) | (4u << 13) | 2);
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_EQ(bench.findings[0], "FLASH: too few wait states for HCLK");
}

}  // namespace
}  // namespace whirl::stm32

// LSE runs at 32768 Hz: with the reset prescalers (128 and 256) the calendar ticks each second.
#include "io_bridges/qemu/stm32/rtc.hpp"

#include <gtest/gtest.h>

#include "io_bridges/qemu/stm32/rtc_f1.hpp"
#include "io_bridges/qemu/stm32/tests/bare_chip.hpp"

namespace whirl::stm32 {
namespace {

using namespace test;

constexpr Nanoseconds kSecond = 1'000'000'000;
enum : std::uint32_t {
  TR = 0,
  DR = 4,
  CR = 8,
  ISR = 12,
  PRER = 16,
  WUTR = 20,
  ALRMAR = 28,
  WPR = 36,
  SSR = 40,
  BKP0R = 0x50
};

struct F405Rtc {
  BareChip bare;
  bool writable = true;
  std::map<int, bool> lines;
  Rtc rtc{bare.chip(),
          {[] { return 32768.0; }, [this] { return writable; },
           [this](int line, bool level) { lines[line] = level; }}};

  void unlock() {
    put(rtc, WPR, 0xCA);
    put(rtc, WPR, 0x53);
  }
  // As every driver does it: 2026-02-28 (a Saturday) 23:59:58.
  void set() {
    unlock();
    put(rtc, ISR, 0x80);
    bare.run_to(bare.events.now() + 100'000);
    EXPECT_NE(get(rtc, ISR) & 0x40, 0u);
    put(rtc, TR, 0x235958);
    put(rtc, DR, 0x26C228);
    put(rtc, ISR, 0);
    put(rtc, WPR, 0xFF);
  }
};

TEST(RtcF405, MidnightTurnsTheDayTheMonthAndTheWeekday) {
  F405Rtc f;
  f.set();
  const Nanoseconds start = f.bare.events.now();
  f.bare.run_to(start + kSecond + kSecond / 2);
  EXPECT_EQ(get(f.rtc, TR), 0x235959u);
  EXPECT_EQ(get(f.rtc, DR), 0x26C228u);
  f.bare.run_to(start + 2 * kSecond + kSecond / 2);
  EXPECT_EQ(get(f.rtc, TR), 0x000000u);
  EXPECT_EQ(get(f.rtc, DR), 0x26E301u);  // Sunday, 1 March: 2026 is no leap year
}

TEST(RtcF405, TheShadowOfTheDateIsHeldUntilItIsRead) {
  F405Rtc f;
  f.set();
  const Nanoseconds start = f.bare.events.now();
  f.bare.run_to(start + kSecond + kSecond / 2);
  EXPECT_EQ(get(f.rtc, TR), 0x235959u);
  f.bare.run_to(start + 2 * kSecond + kSecond / 2);
  EXPECT_EQ(get(f.rtc, DR), 0x26C228u);
  get(f.rtc, TR);
  EXPECT_EQ(get(f.rtc, DR), 0x26E301u);
}

TEST(RtcF405, SubSecondsCountDownFromThePrescaler) {
  F405Rtc f;
  f.set();
  f.bare.run_to(f.bare.events.now() + kSecond / 4);
  EXPECT_EQ(get(f.rtc, SSR), 255u - 64u + (0u));
}

TEST(RtcF405, WithoutKeysOrDbpNothingIsWritten) {
  F405Rtc f;
  put(f.rtc, WUTR, 5);
  EXPECT_EQ(get(f.rtc, WUTR), 0xFFFFu);
  f.writable = false;
  put(f.rtc, BKP0R, 77);
  EXPECT_EQ(get(f.rtc, BKP0R), 0u);
  f.writable = true;
  put(f.rtc, BKP0R, 77);
  EXPECT_EQ(get(f.rtc, BKP0R), 77u);
  f.rtc.reset();
  EXPECT_EQ(get(f.rtc, BKP0R), 77u);
  f.rtc.reset_backup_domain();
  EXPECT_EQ(get(f.rtc, BKP0R), 0u);
}

TEST(RtcF405, InitialisationAndSynchronisationTakeTwoClocks) {
  F405Rtc f;
  f.bare.run_to(kSecond);
  f.unlock();
  put(f.rtc, ISR, 0x80);
  EXPECT_EQ(get(f.rtc, ISR) & 0x40, 0u);
  f.bare.run_to(kSecond + 61'036);  // two periods of 30.518 us
  EXPECT_EQ(get(f.rtc, ISR) & 0x40, 0x40u);
}

TEST(RtcF405, AlarmRaisesItsLineAtItsSecond) {
  F405Rtc f;
  f.set();
  const Nanoseconds start = f.bare.events.now();
  f.unlock();
  put(f.rtc, ALRMAR, 0x80000000 | 0x000001);  // any day, 00:00:01
  put(f.rtc, CR, 1u << 8 | 1u << 12);
  f.bare.run_to(start + 3 * kSecond - 40'000);
  EXPECT_FALSE(f.lines[17]);
  f.bare.run_to(start + 3 * kSecond + 40'000);
  EXPECT_TRUE(f.lines[17]);
  put(f.rtc, ISR, ~0x100u & ~0x80u);
  EXPECT_FALSE(f.lines[17]);
}

TEST(RtcF405, WakeupComesEveryReloadPlusOneClocks) {
  F405Rtc f;
  f.unlock();
  put(f.rtc, WUTR, 2047);  // RTC / 16: 2048 Hz, so each second
  put(f.rtc, CR, 1u << 10 | 1u << 14);
  f.bare.run_to(kSecond - 1);
  EXPECT_FALSE(f.lines[22]);
  f.bare.run_to(kSecond);
  EXPECT_TRUE(f.lines[22]);
  put(f.rtc, ISR, ~0x400u & ~0x80u);
  f.bare.run_to(2 * kSecond);
  EXPECT_TRUE(f.lines[22]);
}

TEST(RtcF103, TheCounterRunsOncePerPrescalerAndKeepsItsConfigurationProtocol) {
  BareChip bare;
  RtcF1 rtc(
      bare.chip(), 3, [] { return 40'000.0; }, [] { return true; }, {});
  put(rtc, 0x0C, 39'999);  // without CNF: ignored
  put(rtc, 0x04, 0x10);
  put(rtc, 0x08, 0);
  put(rtc, 0x0C, 39'999);
  put(rtc, 0x18, 1);
  put(rtc, 0x1C, 0xFFFF);
  put(rtc, 0x00, 1);
  put(rtc, 0x04, 0);
  EXPECT_EQ(get(rtc, 0x04) & 0x20, 0u);
  bare.run_to(75'000);  // three periods of 25 us
  EXPECT_EQ(get(rtc, 0x04) & 0x20, 0x20u);
  bare.run_to(kSecond);
  EXPECT_TRUE(bare.interrupts.lines[3]);
  EXPECT_EQ(get(rtc, 0x18) << 16 | get(rtc, 0x1C), 0x20000u);
}

TEST(BackupF103, RegistersSurviveASystemResetAndObeyDbp) {
  bool writable = false;
  BackupRegisters backup([&] { return writable; });
  put(backup, 0x04, 0x1234);
  EXPECT_EQ(get(backup, 0x04), 0u);
  writable = true;
  put(backup, 0x04, 0x51234);
  backup.reset();
  EXPECT_EQ(get(backup, 0x04), 0x1234u);
}

}  // namespace
}  // namespace whirl::stm32

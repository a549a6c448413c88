// Which pulses are followed, and whose set-points.
#include "firmware/esc/core/pulse_throttle.hpp"

#include <gtest/gtest.h>

namespace fw::esc {
namespace {

using Source = ThrottleSources::Source;

int read(PulseThrottle& p, std::uint32_t width_us, std::uint32_t period_us = 20'000) {
  std::uint16_t v = 9999;
  return p.read(width_us, period_us, v) ? v : -1;
}

TEST(PulseThrottle, ThesisRangeSpansAllSetPoints) {
  EXPECT_EQ(PulseThrottle::setpoint_of(1099), 0);
  EXPECT_EQ(PulseThrottle::setpoint_of(1100), 1);
  EXPECT_EQ(PulseThrottle::setpoint_of(1525), 1024);  // half of the range
  EXPECT_EQ(PulseThrottle::setpoint_of(1950), 2047);
  EXPECT_EQ(PulseThrottle::setpoint_of(2100), 2047);
}

TEST(PulseThrottle, FirstPulseAndJumpsWaitForASecondOne) {
  PulseThrottle p;
  EXPECT_EQ(read(p, 1500), -1);
  EXPECT_EQ(read(p, 1502), PulseThrottle::setpoint_of(1502));
  EXPECT_EQ(read(p, 1540), PulseThrottle::setpoint_of(1540));  // a small step is taken at once
  EXPECT_EQ(read(p, 1900), -1);
  EXPECT_EQ(read(p, 1540), PulseThrottle::setpoint_of(1540));  // it was a glitch
  EXPECT_EQ(read(p, 1900), -1);
  EXPECT_EQ(read(p, 1900), PulseThrottle::setpoint_of(1900));
}

TEST(PulseThrottle, PulsesOutsideOfTheFormAreCountedAndNothingElse) {
  PulseThrottle p;
  read(p, 1500);
  read(p, 1500);
  for (std::uint32_t width_us : {0u, 5u, 899u, 2101u, 30'000u}) EXPECT_EQ(read(p, width_us), -1);
  for (std::uint32_t period_us : {22'001u, 65'535u}) EXPECT_EQ(read(p, 1500, period_us), -1);
  EXPECT_EQ(p.rejected(), 7u);
  EXPECT_GT(read(p, 1500), 0);  // still the last one
}

// 1900 us, low for 50 us after 600 us: the captures are (600, 650) and (1250, 19350).
TEST(PulseThrottle, APieceOfACutPulseIsNotObeyedEvenIfEveryPulseIsCut) {
  PulseThrottle p;
  read(p, 1900);
  read(p, 1900);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(read(p, 600, 650), -1);
    EXPECT_EQ(read(p, 1250, 19'350), -1);
  }
  EXPECT_GT(read(p, 1900), 0);
}

TEST(PulseThrottle, ZerosComeNoFasterThanFiftyHertz) {
  PulseThrottle p;
  int zeros = 0;
  for (int i = 0; i < 400; ++i) zeros += read(p, 1000, 2500) == 0 ? 1 : 0;  // one second at 400 Hz
  EXPECT_GE(zeros, 48);
  EXPECT_LE(zeros, 50);
  EXPECT_GT(read(p, 1040, 2500) + read(p, 1090, 2500) + read(p, 1130, 2500), -1);  // up at once
}

TEST(PulseThrottle, OfASourceWhoseClockIsABitFastEveryLowPulseIsAZero) {
  PulseThrottle p;
  int zeros = 0;
  for (int i = 0; i < 26; ++i) zeros += read(p, 1000, 19'998) == 0 ? 1 : 0;
  EXPECT_EQ(zeros, 25) << "but the first, which waits for a second one";
}

TEST(ThrottleSources, I2cTakesOverWhileNotArmedAndPulsesOnlyAfterItsSilence) {
  ThrottleSources s;
  EXPECT_TRUE(s.admit(Source::pulses, false));
  EXPECT_TRUE(s.admit(Source::i2c, false));
  EXPECT_FALSE(s.admit(Source::pulses, false));
  for (int ms = 0; ms < 499; ++ms) s.tick();
  EXPECT_FALSE(s.admit(Source::pulses, false));
  s.tick();
  EXPECT_TRUE(s.admit(Source::pulses, false));
}

TEST(ThrottleSources, WhoArmedItKeepsIt) {
  ThrottleSources s;
  EXPECT_TRUE(s.admit(Source::pulses, false));
  EXPECT_FALSE(s.admit(Source::i2c, true));
  EXPECT_TRUE(s.admit(Source::pulses, true));
  EXPECT_EQ(s.owner(), Source::pulses);
}

TEST(ThrottleSources, CanStandsBetweenI2cAndPulses) {
  ThrottleSources s;
  EXPECT_TRUE(s.admit(Source::pulses, false));
  EXPECT_TRUE(s.admit(Source::can, false));
  EXPECT_FALSE(s.admit(Source::pulses, false));
  EXPECT_TRUE(s.admit(Source::i2c, false));
  EXPECT_FALSE(s.admit(Source::can, false));
  for (int ms = 0; ms < 500; ++ms) s.tick();
  EXPECT_TRUE(s.admit(Source::can, false));
  EXPECT_FALSE(s.admit(Source::i2c, true));  // who armed it keeps it
}

}  // namespace
}  // namespace fw::esc

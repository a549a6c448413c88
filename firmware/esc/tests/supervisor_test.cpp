#include "firmware/esc/core/supervisor.hpp"

#include <gtest/gtest.h>

namespace fw::esc {
namespace {

constexpr float kFull_V = 16.4f;

void send(Supervisor& s, int times, std::uint16_t v, float volts = kFull_V, bool at_rest = true) {
  for (int i = 0; i < times; ++i) s.on_setpoint(v, volts, at_rest);
}

TEST(Supervisor, TwentyFiveZerosInARowArmAndTwentyFourDoNot) {
  Supervisor s({});
  send(s, 24, 0);
  EXPECT_FALSE(s.armed());
  send(s, 1, 5);  // breaks the row
  send(s, 24, 0);
  EXPECT_FALSE(s.armed());
  send(s, 1, 0);
  EXPECT_TRUE(s.armed());
}

TEST(Supervisor, SetpointsBeforeArmingAreNotObeyed) {
  Supervisor s({});
  send(s, 100, 700);
  EXPECT_EQ(s.setpoint(), 0);
  send(s, 25, 0);
  send(s, 1, 700);
  EXPECT_EQ(s.setpoint(), 700);
}

TEST(Supervisor, RefusesToArmBelowTheFloorAndOnNoVoltageAtAll) {
  Supervisor s({});
  send(s, 25, 0, 15.69f);
  EXPECT_FALSE(s.armed());
  EXPECT_TRUE(s.refused_for_voltage());
  send(s, 1, 0, __builtin_nanf(""));
  EXPECT_FALSE(s.armed());
  send(s, 1, 0, 15.7f);
  EXPECT_TRUE(s.armed());
}

TEST(Supervisor, HalfASecondOfSilenceStopsAndDisarms) {
  Supervisor s({});
  send(s, 25, 0);
  send(s, 1, 900);
  for (int ms = 0; ms < 499; ++ms) s.tick();
  EXPECT_EQ(s.setpoint(), 900);
  s.tick();
  EXPECT_EQ(s.setpoint(), 0);
  EXPECT_FALSE(s.armed());
  send(s, 1, 900);
  EXPECT_EQ(s.setpoint(), 0) << "a late set-point does not restart the motor";
}

TEST(Supervisor, ALatchedFaultNeedsTwentyFiveZerosAtRest) {
  Supervisor s({});
  send(s, 25, 0);
  send(s, 1, 900);
  s.latch(Latched::over_current);
  s.latch(Latched::desync);
  EXPECT_EQ(s.latched(), Latched::over_current) << "the first fault is the one to report";
  send(s, 40, 0, kFull_V, /*at_rest=*/false);
  EXPECT_EQ(s.latched(), Latched::over_current);
  send(s, 25, 0);
  EXPECT_EQ(s.latched(), Latched::none);
  EXPECT_TRUE(s.armed());
}

TEST(Supervisor, TheStandMayTurnTheKeepAliveOff) {
  Supervisor s({});
  s.watch(false);
  send(s, 25, 0);
  send(s, 1, 900);
  for (int ms = 0; ms < 10'000; ++ms) s.tick();
  EXPECT_EQ(s.setpoint(), 900);
}

}  // namespace
}  // namespace fw::esc

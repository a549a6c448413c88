#include "harness/flight/transmitter.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "base/near.hpp"
#include "harness/flight/tests/milliseconds.hpp"
#include "harness/lua/table.hpp"
#include "harness/plan/requests.hpp"

namespace whirl::flight {
namespace {

struct Pilot {
  // What a plan writes behind `rc =`; its complaint, or "none".
  std::string ask(const std::string& text) {
    const auto table = lua::read_text("return { rc = " + text + " }", "plan.lua").value();
    const auto commands = plan::read_commands(table);
    if (!commands) return commands.error().message();
    transmitter.set(std::get<request::Sticks>(commands.value().at(0)));
    return "none";
  }
  void run_ms(int ms) {
    io::Batch sensed;
    for (int k = 0; k < ms; ++k, t_ns += kMs) transmitter.step(t_ns, sensed);
    for (io::Reader r(sensed.bytes()); r.next();) {
      EXPECT_EQ(r.header().kind, io::Kind::rc_channels);
      sent.push_back(r.as<io::RcChannels>());
      at_ns.push_back(r.header().t_ns);
    }
  }
  Transmitter transmitter;
  std::int64_t t_ns = 0;
  std::vector<io::RcChannels> sent;
  std::vector<std::int64_t> at_ns;
};

TEST(Transmitter, IsOffUntilTheFirstCommandAndThenSendsFiftyTimesASecond) {
  Pilot pilot;
  pilot.run_ms(100);
  EXPECT_TRUE(pilot.sent.empty());
  EXPECT_EQ(pilot.ask("{}"), "none");
  pilot.run_ms(1000);
  ASSERT_EQ(pilot.sent.size(), 50u);
  EXPECT_EQ(pilot.at_ns[1] - pilot.at_ns[0], 20 * kMs);
  const auto& p = pilot.sent[0].position;
  EXPECT_EQ((std::vector<double>{p[0], p[1], p[2], p[3], p[4], p[5]}),
            (std::vector<double>{0.0, 0.0, -1.0, 0.0, -1.0, -1.0}));
}

TEST(Transmitter, SendsToTheBoardThatHasTheReceiver) {
  Transmitter transmitter(3);
  transmitter.set({});
  io::Batch sensed;
  transmitter.step(0, sensed);
  io::Reader reader(sensed.bytes());
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.header().board, 3);
}

TEST(Transmitter, TheArmSwitchIsChannelSix) {
  Pilot pilot;
  EXPECT_EQ(pilot.ask("{ arm = true }"), "none");
  EXPECT_EQ(pilot.ask("{ thrust = '50 %' }"), "none");
  pilot.run_ms(1);
  EXPECT_EQ(pilot.sent.at(0).position[5], 1.0);
}

// The order of channels: roll, pitch, thrust, yaw, mode.
TEST(Transmitter, WhatIsLeftOutStays) {
  Pilot pilot;
  EXPECT_EQ(
      pilot.ask("{ roll = '20 %', pitch = '-30 %', thrust = '75 %', yaw = '10 %', mode = 2 }"),
      "none");
  EXPECT_EQ(pilot.ask("{ pitch = '40 %' }"), "none");
  pilot.run_ms(1);
  const auto& p = pilot.sent.at(0).position;
  const double want[] = {0.2, 0.4, 0.5, 0.1, 0.0};
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(near(p[i], want[i], round_off(2, 1.0))) << i;
}

TEST(Transmitter, SwitchedOffItFallsSilentAndKeepsItsSticks) {
  Pilot pilot;
  EXPECT_EQ(pilot.ask("{ roll = '50 %', mode = 3 }"), "none");
  pilot.run_ms(100);
  EXPECT_EQ(pilot.ask("{ on = false }"), "none");
  pilot.sent.clear();
  pilot.run_ms(100);
  EXPECT_TRUE(pilot.sent.empty());
  EXPECT_EQ(pilot.ask("{}"), "none");
  pilot.run_ms(20);
  EXPECT_EQ(pilot.sent.at(0).position[0], 0.5);
  EXPECT_EQ(pilot.sent.at(0).position[4], 1.0);
}

TEST(Transmitter, BeyondItsTravelAndUnknownSticksAreRefused) {
  Pilot pilot;
  EXPECT_NE(pilot.ask("{ roll = '101 %' }"), "none");
  EXPECT_NE(pilot.ask("{ thrust = '-1 %' }"), "none");
  EXPECT_NE(pilot.ask("{ mode = 4 }"), "none");
  EXPECT_NE(pilot.ask("{ flaps = '10 %' }"), "none");
}

}  // namespace
}  // namespace whirl::flight

// What the pilot asks for, from frames as a receiver gives them.
#include "firmware/flight/pilot.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"
#include "firmware/drivers/cppm_receiver.hpp"
#include "firmware/flight/receiver_choice.hpp"

namespace fw {
namespace {

struct Sticks {
  std::uint16_t roll = 1500, pitch = 1500, throttle = 1000, yaw = 1500, mode = 1000, arm = 1000;
};

CppmFrame frame_of(const Sticks& s) {
  CppmFrame frame;
  frame.channels_us = {s.roll, s.pitch, s.throttle, s.yaw, s.mode, s.arm, 1500, 1500};
  frame.count = 8;
  return frame;
}

// A frame each 22 ms.
void send(Pilot& pilot, const CppmFrame& frame, int times) {
  for (int i = 0; i < times; ++i) {
    pilot.on_frame(frame.channels());
    for (int ms = 0; ms < 22; ++ms) pilot.tick();
  }
}

void wait_ms(Pilot& pilot, int ms) {
  for (int i = 0; i < ms; ++i) pilot.tick();
}

TEST(Pilot, SticksAreSharesOfTheirTravel) {
  Pilot pilot;
  EXPECT_EQ(pilot.link(), PilotLink::never_heard);
  send(pilot, frame_of({.roll = 2000, .pitch = 1000, .throttle = 2000, .yaw = 1750}), 3);
  EXPECT_EQ(pilot.link(), PilotLink::ok);
  const PilotDemand& demand = pilot.demand();
  EXPECT_TRUE(whirl::near(demand.roll, 1.0, whirl::stated(1e-5, "floats")));
  EXPECT_TRUE(whirl::near(demand.pitch, -1.0, whirl::stated(1e-5, "floats")));
  EXPECT_TRUE(whirl::near(demand.throttle, 1.0, whirl::stated(1e-5, "floats")));
  EXPECT_TRUE(whirl::near(demand.yaw, 0.5, whirl::stated(1e-5, "floats")));
  EXPECT_FALSE(demand.throttle_low());
}

TEST(Pilot, AStickAboutItsMiddleAsksForNothingAndAThrottleAtItsStopIsLow) {
  Pilot pilot;
  send(pilot, frame_of({.roll = 1519, .pitch = 1481, .throttle = 1010, .yaw = 1500}), 3);
  EXPECT_EQ(pilot.demand().roll, 0.0f);
  EXPECT_EQ(pilot.demand().pitch, 0.0f);
  EXPECT_EQ(pilot.demand().throttle, 0.0f);
  EXPECT_TRUE(pilot.demand().throttle_low());
}

TEST(Pilot, TheSwitchesSelectModeAndArming) {
  const PilotMode modes[] = {PilotMode::attitude, PilotMode::velocity, PilotMode::autonomous};
  for (unsigned i = 0; i < 3; ++i) {
    Pilot pilot;
    send(pilot, frame_of({.mode = static_cast<std::uint16_t>(1000 + 500 * i), .arm = 2000}), 3);
    EXPECT_EQ(pilot.demand().mode, modes[i]);
    EXPECT_TRUE(pilot.demand().arm);
  }
}

TEST(Pilot, OneBadFrameMovesNothing) {
  Pilot pilot;
  const Sticks good{.throttle = 1500, .mode = 1500, .arm = 2000};
  send(pilot, frame_of(good), 5);
  send(pilot, frame_of({.roll = 2000, .throttle = 1000, .yaw = 1000, .mode = 2000, .arm = 1000}),
       1);
  send(pilot, frame_of(good), 1);
  EXPECT_EQ(pilot.demand().roll, 0.0f);
  EXPECT_EQ(pilot.demand().yaw, 0.0f);
  EXPECT_TRUE(whirl::near(pilot.demand().throttle, 0.5, whirl::stated(1e-5, "floats")));
  EXPECT_EQ(pilot.demand().mode, PilotMode::velocity);
  EXPECT_TRUE(pilot.demand().arm);
}

TEST(Pilot, NonsenseIsNoFrameAndEndsTheLink) {
  CppmFrame few = frame_of({});
  few.count = 5;
  const CppmFrame nonsense[] = {few, frame_of({.roll = 899}), frame_of({.arm = 2101}),
                                frame_of({.throttle = 949})};
  for (const CppmFrame& frame : nonsense) {
    Pilot pilot;
    send(pilot, frame_of({.throttle = 1500}), 5);
    send(pilot, frame, 22);  // 484 ms, and 22 since the last good one
    EXPECT_EQ(pilot.link(), PilotLink::nonsense);
    EXPECT_EQ(pilot.frames_refused(), 22u);
    send(pilot, frame_of({.throttle = 1500}), 2);
    EXPECT_EQ(pilot.link(), PilotLink::lost);
    send(pilot, frame_of({.throttle = 1500}), 1);
    EXPECT_EQ(pilot.link(), PilotLink::ok);  // three in a row
  }
}

// Any bits, as long as they are within the limits: a receiver gone mad.
TEST(Pilot, FramesOfAnyValuesMoveTheSticksForHalfASecondAtMost) {
  int moved = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    Pilot pilot;
    send(pilot, frame_of({.throttle = 1500, .mode = 1500, .arm = 2000}), 5);
    std::uint32_t state = seed;
    const auto any_us = [&state] {
      state = state * 1664525u + 1013904223u;
      return static_cast<std::uint16_t>(950u + (state >> 16) % 1151u);
    };
    for (int k = 0; k < 100 && pilot.link() != PilotLink::nonsense; ++k) {
      send(pilot, frame_of({any_us(), any_us(), any_us(), any_us(), any_us(), any_us()}), 1);
      if (pilot.demand().roll != 0.0f) ++moved;
    }
    EXPECT_EQ(pilot.link(), PilotLink::nonsense) << seed;
  }
  // Three agree on both switches once in 80: in the 23 frames of half a second, one time in four.
  EXPECT_LT(moved, 40 * 23);
}

TEST(Pilot, IsLostHalfASecondAfterTheLastFrame) {
  Pilot pilot;
  send(pilot, frame_of({.roll = 2000}), 3);
  wait_ms(pilot, 499 - 22);
  EXPECT_EQ(pilot.link(), PilotLink::ok);
  wait_ms(pilot, 1);
  EXPECT_EQ(pilot.link(), PilotLink::lost);
  EXPECT_EQ(pilot.demand().roll, 1.0f);
}

TEST(ReceiverChoice, TheFirstThatSpeaksIsHeardAndInTheAirNoOther) {
  constexpr auto cppm = ReceiverKind::cppm, sbus = ReceiverKind::sbus;
  for (const auto& [first, other] : {std::pair{cppm, sbus}, {sbus, cppm}}) {
    ReceiverChoice choice;
    std::uint32_t now_us = 0xFFFF'F000;  // it wraps soon
    EXPECT_TRUE(choice.hears(first, now_us, false));
    EXPECT_FALSE(choice.hears(other, now_us += 10'000, false));
    EXPECT_TRUE(choice.hears(first, now_us, false));
    EXPECT_FALSE(choice.hears(other, now_us + 499'999, false));
    EXPECT_FALSE(choice.hears(other, now_us + 5'000'000, true));
    EXPECT_TRUE(choice.hears(first, now_us += 5'000'000, true));
    EXPECT_TRUE(choice.hears(other, now_us + 500'000, false));
    EXPECT_FALSE(choice.hears(first, now_us + 500'001, false));
  }
}

TEST(ReceiverChoice, ATransmitterThatIsSwitchedOnInFlightIsHeard) {
  ReceiverChoice choice;
  EXPECT_TRUE(choice.hears(ReceiverKind::sbus, 1000, true));
}

}  // namespace
}  // namespace fw

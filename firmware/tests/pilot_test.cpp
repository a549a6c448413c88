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

constexpr int kHeard = 11;  // frames until the pilot is heard, again too

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
  send(pilot, frame_of({.roll = 2000, .pitch = 1000, .throttle = 2000, .yaw = 1750}), kHeard);
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
  send(pilot, frame_of({.roll = 1519, .pitch = 1481, .throttle = 1010, .yaw = 1500}), kHeard);
  EXPECT_EQ(pilot.demand().roll, 0.0f);
  EXPECT_EQ(pilot.demand().pitch, 0.0f);
  EXPECT_EQ(pilot.demand().throttle, 0.0f);
  EXPECT_TRUE(pilot.demand().throttle_low());
}

TEST(Pilot, TheSwitchesSelectModeAndArming) {
  const PilotMode modes[] = {PilotMode::attitude, PilotMode::velocity, PilotMode::autonomous};
  for (unsigned i = 0; i < 3; ++i) {
    Pilot pilot;
    send(pilot, frame_of({.mode = static_cast<std::uint16_t>(1000 + 500 * i), .arm = 2000}),
         kHeard);
    EXPECT_EQ(pilot.demand().mode, modes[i]);
    EXPECT_TRUE(pilot.demand().arm);
  }
}

TEST(Pilot, OneBadFrameMovesNothing) {
  Pilot pilot;
  const Sticks good{.throttle = 1500, .mode = 1500, .arm = 2000};
  send(pilot, frame_of(good), kHeard);
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
    send(pilot, frame_of({.throttle = 1500}), kHeard);
    send(pilot, frame, 22);  // 484 ms, and 22 since the last good one
    EXPECT_EQ(pilot.link(), PilotLink::nonsense);
    EXPECT_EQ(pilot.frames_refused(), 22u);
    send(pilot, frame_of({.throttle = 1500}), kHeard - 3);  // the switches are where they were
    EXPECT_EQ(pilot.link(), PilotLink::nonsense);
    send(pilot, frame_of({.throttle = 1500}), 1);
    EXPECT_EQ(pilot.link(), PilotLink::ok);
  }
}

// Any bits, as long as they are within the limits: a receiver gone mad.
TEST(Pilot, FramesOfAnyValuesMoveTheSticksForHalfASecondAtMost) {
  int moved = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    Pilot pilot;
    send(pilot, frame_of({.throttle = 1500, .mode = 1500, .arm = 2000}), kHeard);
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
  // Three agree that both switches are where they were once in some 600: in the 23 frames of half a second, one time in 25.
  EXPECT_LT(moved, 40 * 23 / 5);
}

// As they come from here on, for 20 minutes in all: none is believed again, and each link is over within half a second but
// for one in 25.
TEST(Pilot, FramesOfAnyValuesAreNonsenseSoonAndForGood) {
  int slow = 0;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    Pilot pilot;
    send(pilot, frame_of({.throttle = 1500, .mode = 1500, .arm = 2000}), kHeard);
    std::uint32_t state = seed * 7919u;
    const auto any_us = [&state] {
      state = state * 1664525u + 1013904223u;
      return static_cast<std::uint16_t>(950u + (state >> 16) % 1151u);
    };
    const auto any_frame = [&] {
      send(pilot, frame_of({any_us(), any_us(), any_us(), any_us(), any_us(), any_us()}), 1);
    };
    for (int k = 0; k < 23; ++k) any_frame();
    slow += pilot.link() == PilotLink::nonsense ? 0 : 1;
    for (int k = 0; k < 23; ++k) any_frame();
    const PilotDemand before = pilot.demand();
    for (int k = 0; k < 230; ++k) {
      any_frame();
      ASSERT_EQ(pilot.link(), PilotLink::nonsense) << seed;
    }
    EXPECT_EQ(pilot.demand().roll, before.roll);
    EXPECT_EQ(pilot.demand().mode, before.mode);
  }
  EXPECT_LT(slow, 18);
}

// One in ten, at random: the link holds for a minute.
TEST(Pilot, SingleBadFramesDoNotEndTheLink) {
  Pilot pilot;
  send(pilot, frame_of({.throttle = 1500, .mode = 1500, .arm = 2000}), kHeard);
  std::uint32_t state = 5;
  for (int k = 0; k < 2700; ++k) {
    state = state * 1664525u + 1013904223u;
    const bool bad = (state >> 16) % 10 == 0;
    send(pilot,
         bad ? frame_of({.roll = 2000, .mode = 2000, .arm = 1000})
             : frame_of({.throttle = 1500, .mode = 1500, .arm = 2000}),
         1);
    ASSERT_EQ(pilot.link(), PilotLink::ok) << k;
  }
}

TEST(Pilot, IsLostHalfASecondAfterTheLastFrame) {
  Pilot pilot;
  send(pilot, frame_of({.roll = 2000}), kHeard);
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

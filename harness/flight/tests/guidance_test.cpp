// What the ground station commands by itself: waypoints, a person's hand; and who leads when another
// station speaks.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "base/text.hpp"
#include "harness/flight/teleoperation.hpp"
#include "harness/flight/tests/piloted_flight.hpp"
#include "harness/flight/waypoint_flight.hpp"

namespace whirl::flight {
namespace {

CapturedPose pose_at(const Eigen::Vector3d& p_W_m, std::int64_t t_ns) {
  CapturedPose pose;
  pose.exposed_ns = t_ns;
  pose.p_WB_W_m = p_W_m;
  return pose;
}

const request::Waypoints kTwo{.points = {{1.0, 0.0, -1.0, 0.5, 0.0}, {1.0, 2.0, -1.0, 1.0, 0.3}},
                              .speed_mps = 0.5,
                              .within_m = 0.1};
const Target kStart{{0.0, 0.0, -1.0}, 0.0};

TEST(WaypointFlight, TheCommandedPlaceMovesStraightAtItsSpeed) {
  WaypointFlight flight(kTwo, kStart, 0);
  for (std::int64_t ms = 0; ms <= 3000; ++ms) {
    const SetPoint now = flight.at(ms * kMs, std::nullopt);
    const double want_m = std::min(1.0, 0.5e-3 * static_cast<double>(ms));
    ASSERT_TRUE(near((now.target.p_W_m - Eigen::Vector3d(want_m, 0.0, -1.0)).norm(), 0.0,
                     round_off(1000, 1.0)))
        << ms;
    EXPECT_EQ(now.target.yaw_rad, 0.5);
    EXPECT_FALSE(now.v_W_mps.has_value());
  }
  EXPECT_EQ(flight.reached(), 0);  // nobody was seen there
}

TEST(WaypointFlight, GoesOnWhenTheVehicleWasSeenThereForItsHold) {
  WaypointFlight flight(kTwo, kStart, 0);
  std::int64_t ms = 0;
  const auto run_to = [&](std::int64_t end_ms, const Eigen::Vector3d& seen_W_m) {
    for (; ms <= end_ms; ++ms) flight.at(ms * kMs, pose_at(seen_W_m, ms * kMs));
    return flight.reached();
  };
  EXPECT_EQ(run_to(1900, {1.0, 0.05, -1.0}), 0);  // the command is not there itself: 2 s
  EXPECT_EQ(run_to(2500, {1.0, 0.11, -1.0}), 0);  // 11 cm off
  EXPECT_EQ(run_to(2501, {1.0, 0.05, -1.0}), 1);
  EXPECT_EQ(run_to(7000, {1.0, 1.5, -1.0}), 1);
  EXPECT_EQ(run_to(7200, {1.0, 1.95, -1.0}), 1);  // held 0.2 of 0.3 s
  EXPECT_EQ(run_to(7300, {1.0, 1.5, -1.0}), 1);   // pushed away: the hold begins anew
  EXPECT_EQ(run_to(7599, {1.0, 1.95, -1.0}), 1);
  EXPECT_EQ(run_to(7601, {1.0, 1.95, -1.0}), 2);
  EXPECT_EQ(run_to(9000, {1.0, 1.95, -1.0}), 2);  // there are no more
}

TEST(WaypointFlight, AnOldPoseIsNoSight) {
  WaypointFlight flight(kTwo, kStart, 0);
  for (std::int64_t ms = 0; ms <= 5000; ++ms) {
    flight.at(ms * kMs, pose_at({1.0, 0.0, -1.0}, std::min<std::int64_t>(ms, 1000) * kMs));
  }
  EXPECT_EQ(flight.reached(), 0);
}

// A dead time of 250 ms and a lag of 100 ms: 1 - 1/e of the way at 350 ms, as far as a 20 ms grid tells.
TEST(Teleoperation, TheHandFollowsTheScriptLateAndSmoothly) {
  request::Teleoperation wanted{.script = {{.at_s = 0.0, .north_mps = 1.0}}, .reaction_s = 0.25};
  Teleoperation hand(wanted, kStart, 0);
  double last_mps = 0.0;
  for (std::int64_t ms = 0; ms <= 1000; ++ms) {
    const SetPoint now = hand.at(ms * kMs);
    const double now_mps = now.v_W_mps.value_or(Eigen::Vector3d::Zero()).x();
    if (ms < 250) {
      EXPECT_EQ(now_mps, 0.0) << ms;
    }
    EXPECT_GE(now_mps, last_mps);
    last_mps = now_mps;
    if (ms == 350) {
      EXPECT_TRUE(near(last_mps, 1.0 - std::exp(-1.0), stated(0.08, "a step of the grid")));
    }
    EXPECT_EQ(now.target.p_W_m.z(), -1.0);
  }
  EXPECT_TRUE(near(last_mps, 1.0, stated(0.001, "seven time constants")));
}

TEST(Teleoperation, HeadingIsTheIntegralOfTheRateAndWraps) {
  request::Teleoperation wanted{
      .script = {{.at_s = 0.0, .yaw_rate_radps = 1.0}, {.at_s = 4.0, .yaw_rate_radps = 0.0}}};
  Teleoperation hand(wanted, {{0.0, 0.0, -1.0}, 0.5}, 0);
  double yaw_rad = 0.0;
  for (std::int64_t ms = 0; ms <= 8000; ++ms) yaw_rad = hand.at(ms * kMs).target.yaw_rad;
  EXPECT_TRUE(near(yaw_rad, 4.5 - 2.0 * M_PI, stated(0.001, "begin and end lag alike")));
}

TEST(Teleoperation, WhatAnEntryLeavesOutStays) {
  request::Teleoperation wanted{.script = {{.at_s = 0.0, .north_mps = 1.0, .height_m = 2.0},
                                           {.at_s = 2.0, .east_mps = -0.5}}};
  Teleoperation hand(wanted, kStart, 0);
  SetPoint now;
  for (std::int64_t ms = 0; ms <= 4000; ++ms) now = hand.at(ms * kMs);
  EXPECT_TRUE(
      near((now.v_W_mps.value_or(Eigen::Vector3d::Zero()) - Eigen::Vector3d(1.0, -0.5, 0.0)).norm(),
           0.0, stated(0.001, "of the hand's lag is left")));
  EXPECT_TRUE(near(now.target.p_W_m.z(), -2.0, stated(0.001, "likewise")));
}

// ---- Who leads

std::string hex_of(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  add_hex(bytes, text);
  return text;
}

struct Sent {
  int set_points = 0, poses = 0;
  std::vector<std::vector<std::uint8_t>> all;
};

Sent fly_a_second(Flight& flight) {
  Sent sent;
  for (int i = 0; i < 1000; ++i) {
    flight.step();
    for (io::Reader r(flight.sensed.bytes()); r.next();) {
      if (r.header().kind != io::Kind::uart_frame) continue;
      sent.set_points += r.payload()[7] == 84 ? 1 : 0;  // message id
      sent.poses += r.payload()[7] == 104 ? 1 : 0;
      sent.all.emplace_back(r.payload().begin(), r.payload().end());
    }
  }
  return sent;
}

template <typename Message>
std::vector<std::uint8_t> guest(Message message, std::uint8_t target = 1) {
  io::MavlinkSender sender{254, 1, 0};
  message.target_system = message.target_component = target;
  return io::encode(io::pack(message, sender));
}

void give(Flight& flight, const std::string& lua) {
  const auto given = plan::command(flight.world, table(lua), flight.t_ns);
  ASSERT_TRUE(given.ok()) << given.error().message();
}

TEST(GuestRadio, ItsBytesGoUpAsTheyStand) {
  Flight flight;
  give(flight, "{ radio = 'fd0102' }");
  give(flight, "{ radio = '00' }");
  const Sent sent = fly_a_second(flight);
  EXPECT_EQ(sent.all[0], (std::vector<std::uint8_t>{0xFD, 1, 2}));
  EXPECT_EQ(sent.all[1], (std::vector<std::uint8_t>{0}));
  EXPECT_EQ(sent.poses, 40);
}

TEST(GuestRadio, WhoCommandedLastLeadsAndTheCapturedPosesGoOn) {
  io::CommandLong land, other;
  land.command = 21;
  other.command = 512;
  const struct {
    std::vector<std::uint8_t> bytes;
    bool leads;
  } kFrames[] = {{guest(io::SetPositionTargetLocalNed{}), true},
                 {guest(land), true},
                 {guest(other), false},
                 {guest(land, 9), false},
                 {guest(io::ParamSet{}), false}};
  for (const auto& frame : kFrames) {
    Flight flight;
    give(flight, "{ position = { height = '1 m' } }");
    EXPECT_EQ(fly_a_second(flight).set_points, 10);
    give(flight, "{ radio = '" + hex_of(frame.bytes) + "' }");
    const int own = frame.bytes[7] == 84 ? 1 : 0;  // the guest's own, once
    const Sent sent = fly_a_second(flight);
    EXPECT_EQ(sent.set_points, frame.leads ? own : 10);
    EXPECT_EQ(sent.poses, 40);
    give(flight, "{ position = { height = '1 m' } }");
    EXPECT_EQ(fly_a_second(flight).set_points, 10);
  }
}

}  // namespace
}  // namespace whirl::flight

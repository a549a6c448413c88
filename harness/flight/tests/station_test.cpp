#include <cmath>
#include <numbers>
#include <vector>

#include "base/near.hpp"
#include "harness/flight/tests/station_air.hpp"

namespace whirl::flight {
namespace {

TEST(Station, RepeatsACommandWithRisingConfirmationUntilItIsAcknowledged) {
  Air air;
  air.station.command(400, {1.0f});
  air.run(0, 1000);
  ASSERT_EQ(air.sent.size(), 4u);  // 0, 300, 600, 900 ms
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(io::unpack<io::CommandLong>(air.sent[i])->confirmation, i);
    EXPECT_EQ(air.times[i], static_cast<std::int64_t>(i) * 300 * kMs);
  }
  io::CommandAck ack;
  ack.command = 400;
  air.vehicle_says(ack, 1000 * kMs);
  air.run(1000, 3000);
  EXPECT_EQ(air.sent.size(), 4u);
  EXPECT_EQ(air.station.last_result(), 0);
  EXPECT_FALSE(air.station.command_pending());
}

TEST(Station, GivesUpAfterTwentyTriesAndSaysSo) {
  Air air;
  air.station.command(400, {1.0f});
  air.run(0, 5900);
  EXPECT_EQ(air.station.last_result(), -1);
  air.run(5900, 7000);
  EXPECT_EQ(air.sent.size(), 20u);
  EXPECT_EQ(air.station.last_result(), -2);
  EXPECT_FALSE(air.station.command_pending());
}

TEST(Station, AnAnswerToAnotherCommandDoesNotCount) {
  Air air;
  air.station.command(400, {1.0f});
  air.run(0, 1);
  io::CommandAck ack;
  ack.command = 22;
  air.vehicle_says(ack, kMs);
  EXPECT_TRUE(air.station.command_pending());
}

TEST(Station, CommandsGoOneAfterTheOther) {
  Air air;
  air.station.command(400, {1.0f});
  air.station.command(22, {0, 0, 0, 0, 0, 0, 1.1f});
  air.run(0, 10);
  ASSERT_EQ(air.sent.size(), 1u);
  io::CommandAck ack;
  ack.command = 400;
  air.vehicle_says(ack, 10 * kMs);
  air.run(10, 20);
  ASSERT_EQ(air.sent.size(), 2u);
  EXPECT_EQ(io::unpack<io::CommandLong>(air.sent[1])->param[6], 1.1f);
}

TEST(Station, StreamsItsTargetTenTimesASecond) {
  Air air;
  air.run(0, 1000);
  EXPECT_TRUE(air.sent.empty());
  air.station.set_target(Target{{1.0, 2.0, -1.5}, 0.5});
  air.run(1000, 2000);
  ASSERT_EQ(air.sent.size(), 10u);
  const auto target = io::unpack<io::SetPositionTargetLocalNed>(air.sent[0]);
  ASSERT_TRUE(target);
  EXPECT_EQ(target->z, -1.5f);
  EXPECT_EQ(target->yaw, 0.5f);
  EXPECT_EQ(target->type_mask, 0x09F8);
  EXPECT_EQ(target->coordinate_frame, 1);
}

TEST(Station, HoldsAnAttitudeTwentyTimesASecondInsteadOfItsTarget) {
  Air air;
  air.run(0, 1000);
  air.station.hold({.roll_rad = 0.2, .yaw_rad = 0.3, .yaw_rate_radps = 0.1, .thrust = 0.5},
                   Target{{1.0, 2.0, -1.5}, 0.3});
  air.run(1000, 2000);
  ASSERT_EQ(air.sent.size(), 20u);
  const auto attitude = io::unpack<io::SetAttitudeTarget>(air.sent[0]);
  ASSERT_TRUE(attitude);
  // Half angles of 0.2 about the nose, then 0.3 about down.
  EXPECT_TRUE(near(attitude->q[0], std::cos(0.1) * std::cos(0.15), stated(1e-6, "float")));
  EXPECT_TRUE(near(attitude->q[1], std::sin(0.1) * std::cos(0.15), stated(1e-6, "float")));
  EXPECT_TRUE(near(attitude->q[3], std::cos(0.1) * std::sin(0.15), stated(1e-6, "float")));
  EXPECT_EQ(attitude->body_yaw_rate, 0.1f);
  EXPECT_EQ(attitude->thrust, 0.5f);
  EXPECT_EQ(attitude->type_mask, 0x03);
  EXPECT_EQ(attitude->target_system, 1);
  air.station.set_target(Target{{1.0, 2.0, -1.5}, 0.3});
  air.run(2000, 3000);
  EXPECT_TRUE(io::unpack<io::SetPositionTargetLocalNed>(air.sent.back()));
}

TEST(Station, KnowsNothingBeforeItHears) {
  Air air;
  EXPECT_TRUE(std::isnan(air.station.telemetry(0).height_m));
  io::LocalPositionNed position;
  position.z = -1.25f;
  air.vehicle_says(position, 5 * kMs);
  EXPECT_EQ(air.station.telemetry(0).height_m, 1.25);
  io::Heartbeat beat;
  beat.base_mode = 0x81;
  beat.custom_mode = 2;
  air.vehicle_says(beat, 10 * kMs);
  const Telemetry told = air.station.telemetry(510 * kMs);
  EXPECT_EQ(told.state, 2.0);
  EXPECT_EQ(told.armed, 1.0);
  EXPECT_TRUE(near(told.heartbeat_age_s, 0.5, round_off(4, 0.5)));
}

TEST(Station, TiltIsTheAngleBetweenTheVerticals) {
  Air air;
  io::AttitudeQuaternion attitude;  // 30 degrees about x, then 90 about z: tilt stays 30
  const float a = std::numbers::pi_v<float> / 12.0f, b = std::numbers::pi_v<float> / 4.0f;
  attitude.q1 = std::cos(b) * std::cos(a);
  attitude.q2 = std::cos(b) * std::sin(a);
  attitude.q3 = std::sin(b) * std::sin(a);
  attitude.q4 = std::sin(b) * std::cos(a);
  air.vehicle_says(attitude, 0);
  EXPECT_TRUE(near(air.station.telemetry(0).tilt_rad, std::numbers::pi / 6,
                   stated(1e-5, "single precision")));
}

bool nothing_hides() {
  return false;
}

TEST(Capture, LooksFortyTimesASecondAndSendsLate) {
  Capture capture({}, 1);
  std::vector<CapturedPose> poses;
  for (int ms = 0; ms < 1000; ++ms) {
    const auto pose = capture.look(ms * kMs, {.p_WB_W_m = {1.0, 1.5, -2.0}}, nothing_hides);
    if (pose) poses.push_back(*pose);
  }
  ASSERT_EQ(poses.size(), 40u);
  EXPECT_EQ(poses[1].exposed_ns, 25 * kMs);
  EXPECT_EQ(poses[1].sent_ns, 33 * kMs);
  EXPECT_TRUE(near(poses[1].p_WB_W_m.z(), -2.0, stated(0.002, "6 sigma")));
  EXPECT_NE(poses[1].p_WB_W_m.z(), -2.0);
}

TEST(Capture, OutsideOfTheRoomNothingIsSeen) {
  Capture capture({}, 1);
  EXPECT_TRUE(capture.look(0, {.p_WB_W_m = {2.4, 0.0, -1.0}}, nothing_hides));
  EXPECT_FALSE(capture.look(25 * kMs, {.p_WB_W_m = {2.6, 0.0, -1.0}}, nothing_hides));
}

TEST(Capture, AnOcclusionHidesItsWindowOnly) {
  Capture capture({}, 1), open({}, 1);
  int alike = 0, poses = 0, asked = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    const auto occluded = [&] { return ++asked, ms >= 200 && ms < 400; };
    const auto seen = capture.look(ms * kMs, {}, occluded);
    const auto there = open.look(ms * kMs, {}, nothing_hides);
    const bool hidden = there && there->exposed_ns >= 200 * kMs && there->exposed_ns < 400 * kMs;
    if (seen && there && seen->exposed_ns == there->exposed_ns) {
      EXPECT_FALSE(hidden) << ms;
      EXPECT_EQ(seen->p_WB_W_m, there->p_WB_W_m);  // the noise keeps its place
      ++alike;
    }
    poses += seen ? 1 : 0;
  }
  EXPECT_EQ(alike, 32);   // 1 s at 40 Hz less 0.2 s
  EXPECT_EQ(poses, 33);   // and the camera frame just before the occlusion
  EXPECT_EQ(asked, 200);  // of the cameras' frames, and of nothing else
}

// Five frames of the cameras in each period of the radio: 0.8^5 of the poses are missing, 0.328, of 4000 with a sigma
// of 0.0074; five of them. A frame that was seen may be up to 20 ms old by then.
TEST(Capture, RandomOcclusionTakesThePosesOfWhichNoFrameWasSeen) {
  CaptureParams params;
  params.cameras.occlusion_chance = 0.8;
  Capture capture(params, 1);
  std::int64_t poses = 0, oldest_ns = 0;
  for (int ms = 0; ms < 100'000; ++ms) {
    const auto pose = capture.look(ms * kMs, {}, nothing_hides);
    if (!pose) continue;
    ++poses;
    oldest_ns = std::max(oldest_ns, ms * kMs - pose->exposed_ns);
  }
  EXPECT_TRUE(near(1.0 - static_cast<double>(poses) / 4000.0, 0.32768, stated(0.037, "5 sigma")));
  EXPECT_EQ(oldest_ns, 20 * kMs);
  EXPECT_EQ(capture.passed_on(), poses);
}

TEST(Capture, AnglesFollowTheAerospaceOrder) {
  using Eigen::AngleAxisd;
  const Eigen::Quaterniond q = AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                               AngleAxisd(-0.2, Eigen::Vector3d::UnitY()) *
                               AngleAxisd(0.1, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d rpy = roll_pitch_yaw_rad(q);
  EXPECT_TRUE(near(rpy.x(), 0.1, round_off(10, 1)));
  EXPECT_TRUE(near(rpy.y(), -0.2, round_off(10, 1)));
  EXPECT_TRUE(near(rpy.z(), 0.3, round_off(10, 1)));
}

// The vehicle's UART sees what arrives: here every frame, 10 ms after it was sent.
struct Line : Air {
  std::vector<std::vector<std::uint8_t>> frames;

  Line() {
    send = [this](std::int64_t t_ns, std::span<const std::uint8_t> frame) {
      times.push_back(t_ns);
      frames.emplace_back(frame.begin(), frame.end());
    };
  }
  void arrives(std::size_t i) { station.delivered(frames.at(i), times.at(i) + 10 * kMs); }
};

TEST(Station, ACommandHasPassedTheWireWhenTheFirstFrameThatCarriesItArrives) {
  Line line;
  line.station.set_target(Target{});
  line.run(0, 50);
  ASSERT_EQ(line.frames.size(), 1u);
  line.arrives(0);
  EXPECT_EQ(line.station.on_wire_ns(), 10 * kMs);

  line.station.command(400, {1.0f});
  EXPECT_LT(line.station.on_wire_ns(), 0);
  line.run(50, 400);  // command at 50 and 350, targets at 100, 200 and 300 ms
  ASSERT_EQ(line.times,
            (std::vector<std::int64_t>{0, 50 * kMs, 100 * kMs, 200 * kMs, 300 * kMs, 350 * kMs}));
  line.arrives(2);  // a target: not what was commanded last; the first try of the command is lost
  EXPECT_LT(line.station.on_wire_ns(), 0);
  line.arrives(5);
  EXPECT_EQ(line.station.on_wire_ns(), 360 * kMs);
}

TEST(Station, ANewTargetHasPassedWithItsOwnFrame) {
  Line line;
  line.station.set_target(Target{});
  line.run(0, 50);
  line.station.set_target(Target{{1.0, 0.0, -1.1}, 0.0});
  line.arrives(0);  // carries the old one
  EXPECT_LT(line.station.on_wire_ns(), 0);
  line.run(50, 150);
  line.arrives(1);
  EXPECT_EQ(line.station.on_wire_ns(), 110 * kMs);
  line.station.command(400, {1.0f});
  line.station.command(22, {});  // waits behind the first one
  line.run(150, 160);
  line.arrives(2);
  EXPECT_LT(line.station.on_wire_ns(), 0);
}

TEST(Station, ATargetMovesStraightAtItsSpeedAndStops) {
  Air air;
  air.station.set_target(Target{{1.5, 0.0, -1.1}, 0.0});
  air.run(0, 1000);
  air.station.move_target(Target{{-1.5, 0.0, -1.1}, 0.0}, 0.3);
  air.run(1000, 6000);  // 1.5 m in 5 s
  EXPECT_TRUE(near(air.station.target()->p_W_m.x(), 0.0, stated(0.0004, "one step")));
  air.run(6000, 12000);
  EXPECT_EQ(air.station.target()->p_W_m.x(), -1.5);
  const auto last = io::unpack<io::SetPositionTargetLocalNed>(air.sent.back());
  EXPECT_EQ(last->x, -1.5f);
}

}  // namespace
}  // namespace whirl::flight

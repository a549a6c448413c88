// What QGroundControl asks beside flying: frames in as the MAVLink definitions lay them out, answers out.
#include "firmware/link/request_link.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "firmware/link/telemetry.hpp"

namespace fw {
namespace {

using mavlink::Frame, mavlink::Message;

class Asked : public ::testing::Test {
 protected:
  void hear(Message message) {
    const auto bytes = message.frame(255, 190, 0);
    telemetry_.receive({bytes.data(), bytes.size()});
  }
  void hear_command(std::uint16_t command, float param1, std::uint8_t system = 1,
                    std::uint8_t component = 1) {
    Message m(mavlink::kCommandLong, 33);
    hear(m.put(0, param1).put(28, command).put(30, system).put(31, component));
  }
  // All of this message that come down within a second.
  std::vector<Frame> answers(std::uint32_t id) {
    std::vector<Frame> all;
    mavlink::Parser parser;
    for (std::uint32_t slot = 0; slot < 200; ++slot) {
      for (const std::uint8_t byte : telemetry_.next(1000 + 5 * slot, {}, {})) {
        if (parser.push(byte) && parser.frame().id == id) all.push_back(parser.frame());
      }
    }
    return all;
  }
  // Of the one COMMAND_ACK that comes.
  int ack_of(std::uint16_t command) {
    const auto acks = answers(mavlink::kCommandAck);
    EXPECT_EQ(acks.size(), 1u);
    if (acks.empty()) return -1;
    EXPECT_EQ(acks[0].get<std::uint16_t>(0), command);
    return acks[0].get<std::uint8_t>(2);
  }

  Flight flight_;
  Telemetry telemetry_{flight_};
};

TEST_F(Asked, TellsItsVersionWhenTheMessageOrTheCapabilitiesAreRequested) {
  for (const auto& [command, param1] :
       {std::pair<std::uint16_t, float>{512, 148.0f}, {520, 1.0f}}) {
    hear_command(command, param1);
    const auto versions = answers(mavlink::kAutopilotVersion);
    ASSERT_EQ(versions.size(), 1u) << command;
    // MAV_PROTOCOL_CAPABILITY: SET_POSITION_TARGET_LOCAL_NED, MAVLINK2, PARAM_ENCODE_C_CAST
    EXPECT_EQ(versions[0].get<std::uint64_t>(0), 128u + 8192u + 131072u);
    EXPECT_EQ(versions[0].get<std::uint32_t>(16), 0x00010000u);
  }
}

TEST_F(Asked, AcknowledgesEachCommandOnce) {
  hear_command(512, 148.0f);
  EXPECT_EQ(ack_of(512), 0);
  hear_command(512, 397.0f);  // COMPONENT_METADATA: not ours to tell
  EXPECT_EQ(ack_of(512), 2);
  hear_command(511, 30.0f);  // SET_MESSAGE_INTERVAL
  EXPECT_EQ(ack_of(511), 3);
  Message m(mavlink::kCommandInt, 35);
  hear(m.put<std::uint16_t>(28, 192).put<std::uint8_t>(30, 1).put<std::uint8_t>(31, 1));
  EXPECT_EQ(ack_of(192), 3);
}

TEST_F(Asked, ABurstOfCommandsIsAcknowledgedInItsOrder) {
  for (std::uint16_t command = 600; command < 608; ++command) hear_command(command, 0.0f);
  const auto acks = answers(mavlink::kCommandAck);
  ASSERT_EQ(acks.size(), 8u);
  for (std::uint16_t i = 0; i < 8; ++i) EXPECT_EQ(acks[i].get<std::uint16_t>(0), 600 + i);
}

TEST_F(Asked, WhatIsForOthersIsNotAnswered) {
  hear_command(512, 148.0f, 2, 1);
  hear_command(512, 148.0f, 1, 100);  // a camera
  EXPECT_TRUE(answers(mavlink::kCommandAck).empty());
  Message list(mavlink::kMissionRequestList, 3);
  hear(list.put<std::uint8_t>(0, 7).put<std::uint8_t>(1, 1));
  EXPECT_TRUE(answers(mavlink::kMissionCount).empty());
}

TEST_F(Asked, HasAnEmptyMissionOfEachKind) {
  for (std::uint8_t kind : {0, 1, 2}) {  // mission, fence, rally points
    Message list(mavlink::kMissionRequestList, 3);
    hear(list.put<std::uint8_t>(0, 1).put<std::uint8_t>(1, 1).put(2, kind));
    const auto counts = answers(mavlink::kMissionCount);
    ASSERT_EQ(counts.size(), 1u);
    EXPECT_EQ(counts[0].get<std::uint16_t>(0), 0);
    EXPECT_EQ(counts[0].get<std::uint8_t>(2), 255);
    EXPECT_EQ(counts[0].get<std::uint8_t>(3), 190);
    EXPECT_EQ(counts[0].get<std::uint8_t>(4), kind);
  }
}

TEST_F(Asked, RefusesAMissionAndAcceptsToClearTheEmptyOne) {
  Message count(mavlink::kMissionCount, 5);
  hear(count.put<std::uint16_t>(0, 12).put<std::uint8_t>(2, 1).put<std::uint8_t>(3, 1));
  auto acks = answers(mavlink::kMissionAck);
  ASSERT_EQ(acks.size(), 1u);
  EXPECT_EQ(acks[0].get<std::uint8_t>(2), 3);  // MAV_MISSION_UNSUPPORTED
  Message clear(mavlink::kMissionClearAll, 3);
  hear(clear.put<std::uint8_t>(0, 1).put<std::uint8_t>(1, 1));
  acks = answers(mavlink::kMissionAck);
  ASSERT_EQ(acks.size(), 1u);
  EXPECT_EQ(acks[0].get<std::uint8_t>(2), 0);
}

TEST_F(Asked, SendsTimesyncAndPingBack) {
  Message sync(mavlink::kTimesync, 16);
  hear(sync.put<std::int64_t>(0, 0).put<std::int64_t>(8, 123'456'789'012));
  const auto times = answers(mavlink::kTimesync);
  ASSERT_EQ(times.size(), 1u);
  EXPECT_EQ(times[0].get<std::int64_t>(8), 123'456'789'012);
  EXPECT_GE(times[0].get<std::int64_t>(0), 1'000'000'000);
  EXPECT_LT(times[0].get<std::int64_t>(0), 2'000'000'000);
  hear(sync.put<std::int64_t>(0, 5));  // somebody's answer
  EXPECT_TRUE(answers(mavlink::kTimesync).empty());
  Message ping(mavlink::kPing, 14);
  hear(ping.put<std::uint64_t>(0, 77).put<std::uint32_t>(8, 9));
  const auto pings = answers(mavlink::kPing);
  ASSERT_EQ(pings.size(), 1u);
  EXPECT_EQ(pings[0].get<std::uint64_t>(0), 77u);
  EXPECT_EQ(pings[0].get<std::uint32_t>(8), 9u);
  EXPECT_EQ(pings[0].get<std::uint8_t>(12), 255);
  hear(ping.put<std::uint8_t>(12, 1));  // an answer to somebody's ping
  EXPECT_TRUE(answers(mavlink::kPing).empty());
}

}  // namespace
}  // namespace fw

#include "io_bridges/protocols/mavlink.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io_bridges/protocols/mavlink_messages.hpp"

namespace whirl::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes from_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i < text.size(); i += 3) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

// Golden frames made with mavlink/c_library_v2.
const Bytes kHeartbeat = from_hex("FD 09 00 00 00 01 01 00 00 00 00 00 00 00 02 0C 81 04 03 63 8C");
const Bytes kAttitude =
    from_hex("FD 10 00 00 01 01 01 1E 00 00 E8 03 00 00 CD CC CC 3D CD CC 4C BE 9A 99 99 3E 9C 5E");
const Bytes kArm = from_hex(
    "FD 20 00 00 02 FF BE 4C 00 00 00 00 80 3F 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 90 01 01 01 42 DB");

// The specification's own accumulate step, over all but the first byte, then CRC_EXTRA.
void add_crc(Bytes& frame, unsigned crc_extra) {
  unsigned crc = 0xFFFF;
  const auto add = [&crc](unsigned byte) {
    unsigned tmp = (byte ^ crc) & 0xFF;
    tmp = (tmp ^ tmp << 4) & 0xFF;
    crc = (crc >> 8 ^ tmp << 8 ^ tmp << 3 ^ tmp >> 4) & 0xFFFF;
  };
  for (std::size_t i = 1; i < frame.size(); ++i) add(frame[i]);
  add(crc_extra);
  frame.push_back(static_cast<std::uint8_t>(crc));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
}

struct Listener {
  std::vector<MavlinkFrame> frames;
  MavlinkParser parser{[this](const MavlinkFrame& frame, std::span<const std::uint8_t>) {
    frames.push_back(frame);
  }};
  void hear(const Bytes& bytes) {
    for (const std::uint8_t byte : bytes) parser.add(byte);
  }
};

CommandLong arm_command() {
  CommandLong command;
  command.param[0] = 1.0f;
  command.command = 400;
  command.target_system = 1;
  command.target_component = 1;
  return command;
}

TEST(Mavlink, HeartbeatMatchesTheGoldenFrame) {
  Heartbeat beat;
  beat.type = 2;
  beat.autopilot = 12;
  beat.base_mode = 0x81;
  beat.system_status = 4;
  MavlinkSender sender{1, 1, 0};
  EXPECT_EQ(encode(pack(beat, sender)), kHeartbeat);
}

TEST(Mavlink, TrailingZerosAreCutAsInTheGoldenCommand) {
  MavlinkSender sender{255, 190, 2};
  EXPECT_EQ(encode(pack(arm_command(), sender)), kArm);
}

TEST(Mavlink, AnAllZeroPayloadKeepsOneByte) {
  MavlinkSender sender{1, 1, 0};
  LocalPositionNed at_origin;
  EXPECT_EQ(encode(pack(at_origin, sender)).size(), 12u + 1u);
}

TEST(Mavlink, GoldenFramesAreReadBack) {
  Listener listener;
  listener.hear(kHeartbeat);
  listener.hear(kAttitude);
  listener.hear(kArm);
  ASSERT_EQ(listener.frames.size(), 3u);
  EXPECT_EQ(unpack<Heartbeat>(listener.frames[0])->base_mode, 0x81);
  EXPECT_EQ(listener.frames[1].msgid, 30u);
  const auto command = unpack<CommandLong>(listener.frames[2]);
  ASSERT_TRUE(command);
  EXPECT_EQ(command->command, 400);
  EXPECT_EQ(command->param[0], 1.0f);
  EXPECT_EQ(command->confirmation, 0);  // cut on the wire, zero again here
  EXPECT_EQ(listener.frames[2].sysid, 255);
  EXPECT_EQ(listener.parser.counts().lost, 0u);
}

TEST(Mavlink, FindsTheFrameThatHidesBehindAFalseStart) {
  Listener listener;
  listener.hear({0x00, 0xFD, 0x03, 0x00});  // noise that looks like the start of a frame
  listener.hear(kHeartbeat);
  listener.hear(kArm);
  EXPECT_EQ(listener.frames.size(), 2u);
  EXPECT_EQ(listener.parser.counts().stray, 4u);
}

TEST(Mavlink, EveryFlippedBitOfAFrameIsNoticed) {
  for (std::size_t bit = 0; bit < kHeartbeat.size() * 8; ++bit) {
    Bytes bad = kHeartbeat;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ 1u << bit % 8);
    Listener listener;
    listener.hear(bad);
    EXPECT_TRUE(listener.frames.empty()) << bit;
  }
}

TEST(Mavlink, VersionOneIsUnderstood) {
  // The heartbeat above in the old framing.
  Bytes old{0xFE, 9, 7, 1, 1, 0};
  old.insert(old.end(), kHeartbeat.begin() + 10, kHeartbeat.begin() + 19);
  add_crc(old, 50);
  Listener listener;
  listener.hear(old);
  ASSERT_EQ(listener.frames.size(), 1u);
  EXPECT_EQ(unpack<Heartbeat>(listener.frames[0])->type, 2);
}

TEST(Mavlink, LostFramesShowInTheSequence) {
  Listener listener;
  MavlinkSender sender{1, 1, 254};
  const auto frame = [&sender] { return encode(pack(Heartbeat{}, sender)); };
  listener.hear(frame());
  std::ignore = frame();  // 255 never arrives
  listener.hear(frame());
  EXPECT_EQ(listener.parser.counts().lost, 1u);
}

TEST(Mavlink, SignedFramesAreNotTakenForPlainOnes) {
  Bytes signed_frame(kHeartbeat.begin(), kHeartbeat.end() - 2);
  signed_frame[2] = 1;  // incompat flag, under a CRC that fits
  add_crc(signed_frame, 50);
  Listener listener;
  listener.hear(signed_frame);
  EXPECT_TRUE(listener.frames.empty());
}

template <typename Message>
void expect_full_length(std::uint8_t published_length) {
  MavlinkSender sender;
  EXPECT_EQ(pack(Message{}, sender).length, published_length) << Message::kId;
  EXPECT_EQ(mavlink_info(Message::kId)->max_length, published_length) << Message::kId;
}

TEST(Mavlink, StructsAreAsLongAsThePublishedMessages) {
  expect_full_length<Heartbeat>(9);
  expect_full_length<SysStatus>(43);
  expect_full_length<AttitudeQuaternion>(48);
  expect_full_length<LocalPositionNed>(28);
  expect_full_length<CommandLong>(33);
  expect_full_length<CommandAck>(10);
  expect_full_length<SetAttitudeTarget>(51);
  expect_full_length<SetPositionTargetLocalNed>(53);
  expect_full_length<ViconPositionEstimate>(116);
  expect_full_length<HighresImu>(63);
  expect_full_length<Statustext>(54);
  expect_full_length<ParamRequestRead>(20);
  expect_full_length<ParamRequestList>(2);
  expect_full_length<ParamValue>(25);
  expect_full_length<ParamSet>(23);
  expect_full_length<Timesync>(18);
}

TEST(Mavlink, FieldsSitAtThePublishedOffsets) {
  SetPositionTargetLocalNed target;
  target.type_mask = 0x09F8;
  target.coordinate_frame = 1;
  target.yaw = 1.0f;
  MavlinkSender sender;
  const MavlinkFrame frame = pack(target, sender);
  EXPECT_EQ(frame.payload[43], 0x3F);  // yaw at 40..43, 1.0f = 3F800000
  EXPECT_EQ(frame.payload[48], 0xF8);
  EXPECT_EQ(frame.payload[49], 0x09);
  EXPECT_EQ(frame.payload[52], 1);

  SetAttitudeTarget attitude;
  attitude.q = {0.0f, 0.0f, 0.0f, 1.0f};
  attitude.thrust = 1.0f;
  attitude.target_system = 7;
  attitude.type_mask = 0x83;
  const MavlinkFrame turned = pack(attitude, sender);
  EXPECT_EQ(turned.payload[19], 0x3F);  // q[3] at 16..19
  EXPECT_EQ(turned.payload[35], 0x3F);  // thrust at 32..35
  EXPECT_EQ(turned.payload[36], 7);
  EXPECT_EQ(turned.payload[38], 0x83);
}

}  // namespace
}  // namespace whirl::io

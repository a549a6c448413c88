// Oracle: frames made by the generated C library of the MAVLink project (c_library_v2).
#include "firmware/link/mavlink.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fw::mavlink {
namespace {

const std::vector<std::uint8_t> kHeartbeatFrame{0xFD, 0x09, 0x00, 0x00, 0x00, 0x01, 0x01,
                                                0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
                                                0x02, 0x0C, 0x81, 0x04, 0x03, 0x63, 0x8C};
const std::vector<std::uint8_t> kArmFrame{
    0xFD, 0x20, 0x00, 0x00, 0x02, 0xFF, 0xBE, 0x4C, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3F, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x90, 0x01, 0x01, 0x01, 0x42, 0xDB};

int complete_frames(Parser& parser, const std::vector<std::uint8_t>& bytes) {
  int frames = 0;
  for (const std::uint8_t byte : bytes) frames += parser.push(byte) ? 1 : 0;
  return frames;
}

TEST(Mavlink, WritesTheHeartbeatOfTheReferenceLibrary) {
  Message m(kHeartbeat, 9);
  m.put<std::uint32_t>(0, 0).put<std::uint8_t>(4, 2).put<std::uint8_t>(5, 12);
  m.put<std::uint8_t>(6, 0x81).put<std::uint8_t>(7, 4).put<std::uint8_t>(8, 3);
  const auto frame = m.frame(1, 1, 0);
  EXPECT_EQ(std::vector<std::uint8_t>(frame.begin(), frame.end()), kHeartbeatFrame);
}

TEST(Mavlink, ReadsTheArmCommandOfTheReferenceLibrary) {
  Parser parser;
  ASSERT_EQ(complete_frames(parser, kArmFrame), 1);
  EXPECT_EQ(parser.frame().id, kCommandLong);
  EXPECT_EQ(parser.frame().system, 255);
  EXPECT_EQ(parser.frame().component, 190);
  EXPECT_EQ(parser.frame().get<float>(0), 1.0f);
  EXPECT_EQ(parser.frame().get<std::uint16_t>(28), 400);
  EXPECT_EQ(parser.frame().get<std::uint8_t>(32), 0);  // cut off on the wire: zero
}

TEST(Mavlink, RefusesEveryFlippedBit) {
  for (std::size_t bit = 8; bit < 8 * kHeartbeatFrame.size(); ++bit) {
    std::vector<std::uint8_t> broken = kHeartbeatFrame;
    broken[bit / 8] = static_cast<std::uint8_t>(broken[bit / 8] ^ 1u << (bit % 8));
    broken.resize(300, 0);  // a longer length byte takes what follows
    Parser parser;
    EXPECT_EQ(complete_frames(parser, broken), 0) << "bit " << bit;
  }
}

TEST(Mavlink, FindsTheNextFrameAfterNoise) {
  std::vector<std::uint8_t> bytes{0x00, 0x55, 0xAA};
  bytes.insert(bytes.end(), kHeartbeatFrame.begin(), kHeartbeatFrame.end());
  bytes.insert(bytes.end(), kArmFrame.begin(), kArmFrame.end());
  Parser parser;
  EXPECT_EQ(complete_frames(parser, bytes), 2);
}

std::vector<std::uint8_t> together(std::initializer_list<std::vector<std::uint8_t>> parts) {
  std::vector<std::uint8_t> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// A start with a long length, a message that we do not know, one that breaks off: what follows is read.
TEST(Mavlink, WhatIsNoFrameSwallowsNothingOfWhatFollows) {
  const std::vector<std::uint8_t> long_start{0xFD, 0xFF, 0x00},
      unknown{0xFD, 0xC8, 0x00, 0x00, 0x00, 0x01, 0x01, 0xFF, 0xFF, 0x7F, 0x01},
      broken_off(kArmFrame.begin(), kArmFrame.begin() + 30), starts(40, 0xFD);
  for (const auto& noise : {long_start, unknown, starts}) {
    Parser parser;
    EXPECT_EQ(complete_frames(parser, together({noise, kHeartbeatFrame, kArmFrame})), 2);
  }
  Parser
      parser;  // its last fourteen bytes are those of the next frame: that is found with what follows
  EXPECT_EQ(complete_frames(parser, together({broken_off, kHeartbeatFrame, kArmFrame})), 2);
  EXPECT_EQ(parser.bad_frames(), 1u);
}

// The heartbeat with other incompatibility flags, and the CRC that goes with them.
std::vector<std::uint8_t> heartbeat_with_flags(std::uint8_t flags) {
  std::vector<std::uint8_t> bytes = kHeartbeatFrame;
  bytes[2] = flags;
  std::uint16_t crc = 0xFFFF;
  for (std::size_t i = 1; i < 19; ++i) crc = crc_add(crc, bytes[i]);
  crc = crc_add(crc, 50);
  bytes[19] = static_cast<std::uint8_t>(crc);
  bytes[20] = static_cast<std::uint8_t>(crc >> 8);
  return bytes;
}

TEST(Mavlink, DropsFramesWithUnknownIncompatibilityFlags) {
  Parser parser;
  EXPECT_EQ(complete_frames(parser, heartbeat_with_flags(0x02)), 0);
  EXPECT_EQ(complete_frames(parser, heartbeat_with_flags(0x00)), 1);
}

TEST(Mavlink, SkipsTheSignatureOfASignedFrame) {
  std::vector<std::uint8_t> bytes = heartbeat_with_flags(0x01);
  bytes.resize(bytes.size() + 13, 0xFD);  // a signature that looks like frame starts
  bytes.insert(bytes.end(), kArmFrame.begin(), kArmFrame.end());
  Parser parser;
  EXPECT_EQ(complete_frames(parser, bytes), 2);
}

// Trailing zeros are not sent, but one byte of payload always is.
TEST(Mavlink, CutsTrailingZerosDownToOneByte) {
  Message m(kLocalPositionNed, 28);
  EXPECT_EQ(m.frame(1, 1, 0).size(), 12u + 1u);
  EXPECT_EQ(m.frame(1, 1, 0)[1], 1);
}

// CRC-16/MCRF4XX check value over "123456789": 0x6F91.
TEST(Mavlink, CrcHasThePublishedCheckValue) {
  std::uint16_t crc = 0xFFFF;
  for (const char c : {'1', '2', '3', '4', '5', '6', '7', '8', '9'}) {
    crc = crc_add(crc, static_cast<std::uint8_t>(c));
  }
  EXPECT_EQ(crc, 0x6F91);
}

}  // namespace
}  // namespace fw::mavlink

// Golden frames: bytes that PX4, Betaflight and ArduPilot send, checksums worked out by hand.
#include "io_bridges/protocols/ubx.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace whirl::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Golden {
  const char* name;
  UbxFrame frame;
  Bytes bytes;
};

const Golden kGolden[] = {
    {"MON-VER poll", {0x0A, 0x04, {}}, {0xB5, 0x62, 0x0A, 0x04, 0x00, 0x00, 0x0E, 0x34}},
    {"CFG-MSG NAV-SOL 1",
     {0x06, 0x01, {0x01, 0x06, 0x01}},
     {0xB5, 0x62, 0x06, 0x01, 0x03, 0x00, 0x01, 0x06, 0x01, 0x12, 0x4F}},
    {"CFG-MSG NAV-PVT 1",
     {0x06, 0x01, {0x01, 0x07, 0x01}},
     {0xB5, 0x62, 0x06, 0x01, 0x03, 0x00, 0x01, 0x07, 0x01, 0x13, 0x51}},
    {"CFG-RATE 200 ms",
     {0x06, 0x08, {0xC8, 0x00, 0x01, 0x00, 0x00, 0x00}},
     {0xB5, 0x62, 0x06, 0x08, 0x06, 0x00, 0xC8, 0x00, 0x01, 0x00, 0x00, 0x00, 0xDD, 0x68}},
    {"CFG-PRT 38400",
     {0x06, 0x00, {0x01, 0, 0, 0, 0xD0, 0x08, 0, 0, 0, 0x96, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0}},
     {0xB5, 0x62, 0x06, 0x00, 0x14, 0x00, 0x01, 0x00, 0x00, 0x00, 0xD0, 0x08, 0x00, 0x00,
      0x00, 0x96, 0x00, 0x00, 0x01, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x8B, 0x54}},
    {"ACK-ACK of CFG-RATE",
     {0x05, 0x01, {0x06, 0x08}},
     {0xB5, 0x62, 0x05, 0x01, 0x02, 0x00, 0x06, 0x08, 0x16, 0x3F}},
    {"ACK-NAK of CFG-MSG",
     {0x05, 0x00, {0x06, 0x01}},
     {0xB5, 0x62, 0x05, 0x00, 0x02, 0x00, 0x06, 0x01, 0x0E, 0x33}},
};

struct Listener {
  std::vector<UbxFrame> frames;
  UbxParser parser{[this](const UbxFrame& frame) { frames.push_back(frame); }};
  void add(const Bytes& bytes) {
    for (const std::uint8_t byte : bytes) parser.add(byte);
  }
};

TEST(Ubx, GoldenFramesAreWrittenAndRead) {
  for (const Golden& golden : kGolden) {
    EXPECT_EQ(encode(golden.frame), golden.bytes) << golden.name;
    Listener listener;
    listener.add(golden.bytes);
    ASSERT_EQ(listener.frames.size(), 1u) << golden.name;
    EXPECT_EQ(listener.frames[0].message_class, golden.frame.message_class) << golden.name;
    EXPECT_EQ(listener.frames[0].id, golden.frame.id) << golden.name;
    EXPECT_EQ(listener.frames[0].payload, golden.frame.payload) << golden.name;
    EXPECT_EQ(listener.parser.counts().stray, 0u) << golden.name;
  }
}

TEST(Ubx, AFlippedBitAnywhereBehindTheSyncIsRefused) {
  const Bytes good = kGolden[3].bytes;
  for (std::size_t i = 2; i < good.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes bad = good;
      bad[i] = static_cast<std::uint8_t>(bad[i] ^ 1u << bit);
      Listener listener;
      listener.add(bad);
      EXPECT_TRUE(listener.frames.empty()) << i << "." << bit;
    }
  }
}

TEST(Ubx, AFrameBehindACutOneIsFound) {
  Bytes bytes = kGolden[4].bytes;
  bytes.resize(14);  // the line fell silent, then a whole frame
  bytes.insert(bytes.end(), kGolden[1].bytes.begin(), kGolden[1].bytes.end());
  bytes.insert(bytes.end(), kGolden[0].bytes.begin(), kGolden[0].bytes.end());
  bytes.insert(bytes.end(), kGolden[0].bytes.begin(), kGolden[0].bytes.end());
  Listener listener;
  listener.add(bytes);
  ASSERT_EQ(listener.frames.size(), 3u);
  EXPECT_EQ(listener.frames[0].id, 0x01);
  EXPECT_EQ(listener.parser.counts().stray, 14u);
}

TEST(Ubx, ALengthBeyondTheBufferDoesNotSwallowWhatFollows) {
  Listener listener;
  listener.add({0xB5, 0x62, 0x01, 0x02, 0xFF, 0xFF});
  listener.add(kGolden[0].bytes);
  EXPECT_EQ(listener.frames.size(), 1u);
  EXPECT_EQ(listener.parser.counts().too_long, 1u);
}

TEST(Ubx, SyncBytesInDoubleAndTextBetweenAreNoFrames) {
  Listener listener;
  listener.add({0xB5, 0xB5, 0x62, 0x0A, 0x04, 0x00, 0x00, 0x0E, 0x34, '$', 'G', 'P', '\r', '\n'});
  EXPECT_EQ(listener.frames.size(), 1u);
  EXPECT_EQ(listener.parser.counts().stray, 6u);
}

TEST(Ubx, FieldsBeyondThePayloadReadAsZero) {
  const UbxFrame frame{0x06, 0x08, {0xC8, 0x00, 0x01}};
  EXPECT_EQ(frame.get<std::uint16_t>(0), 200);
  EXPECT_EQ(frame.get<std::uint16_t>(2), 0);
}

}  // namespace
}  // namespace whirl::io

// Frames typed from the layout; their checksums from the catalogue's definition of CRC-16/MCRF4XX.
#include "io_bridges/protocols/dronecan/pod_link.hpp"

#include <gtest/gtest.h>

namespace whirl::io {
namespace {

const std::vector<std::uint8_t> kStatusFrame{
    0xA5, 0x81, 0x09, 0x38, 0x01, 0x01, 0x00, 0x18, 0x18, 0x01, 0x10, 0x10, 0x07, 0x03, 0x01, 0x00,
    0x01, 0x00, 0x00, 0x80, 0x01, 0x00, 0x02, 0x00, 0x03, 0x00, 0x04, 0x00, 0x05, 0x00, 0x06, 0x00,
    0xA0, 0x86, 0x01, 0x00, 0x70, 0x11, 0x01, 0x00, 0x71, 0x11, 0x01, 0x00, 0x11, 0x00, 0x00, 0x00,
    0x04, 0x03, 0x02, 0x01, 0x07, 0x00, 0x08, 0x00, 0x09, 0x01, 0x0A, 0x02, 0xDC, 0x27};

std::vector<PodStatus> read(const std::vector<std::uint8_t>& bytes, std::uint64_t damaged) {
  std::vector<PodStatus> all;
  PodLinkReader reader([&](const PodStatus& status) { all.push_back(status); });
  for (const std::uint8_t byte : bytes) reader.add(byte);
  EXPECT_EQ(reader.damaged(), damaged);
  return all;
}

TEST(PodLink, ASampleStandsLowByteFirstUnderItsChecksum) {
  const std::vector<std::uint8_t> want{0xA5, 0x01, 0x07, 0x10, 0x34, 0x12, 0x01, 0x00,
                                       0xFE, 0xFF, 0x00, 0x08, 0xFD, 0xFF, 0x64, 0x00,
                                       0x00, 0x80, 0xFF, 0x7F, 0x5F, 0x94};
  EXPECT_EQ(pack_pod_sample(7, 0x1234, {1, -2, 2048, -3, 100, -32768, 32767}), want);
  EXPECT_EQ(want.size(), kPodSampleBytes);
}

TEST(PodLink, FramesOfThePartsOnI2cStandAsTyped) {
  EXPECT_EQ(pack_pod_esc(2, 3, -100, 4001, 0x83),
            (std::vector<std::uint8_t>{0xA5, 0x06, 0x02, 0x06, 0x03, 0x9C, 0xFF, 0xA1, 0x0F, 0x83,
                                       0x7F, 0x59}));
  EXPECT_EQ(pack_pod_barometer(1, 1, 8569150),
            (std::vector<std::uint8_t>{0xA5, 0x03, 0x01, 0x05, 0x01, 0x3E, 0xC1, 0x82, 0x00, 0xC0,
                                       0x7B}));
}

TEST(PodLink, FramesOfTheLinesStandAsTyped) {
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(pack_pod_bytes(PodEnd::gps, 5, 0x01020304, Bytes{0xAA, 0xBB, 0xCC}),
            (Bytes{0xA5, 0x07, 0x05, 0x07, 0x04, 0x03, 0x02, 0x01, 0xAA, 0xBB, 0xCC, 0x57, 0x71}));
  EXPECT_EQ(pack_pod_baud(PodEnd::gps, 6, 57600),
            (Bytes{0xA5, 0x08, 0x06, 0x04, 0x00, 0xE1, 0x00, 0x00, 0xF4, 0xCB}));
  EXPECT_EQ(pack_pod_bytes(PodEnd::radio, 5, 0, Bytes{0xFE, 0x09}),
            (Bytes{0xA5, 0x0B, 0x05, 0x06, 0x00, 0x00, 0x00, 0x00, 0xFE, 0x09, 0xA0, 0x53}));
  EXPECT_EQ(pack_pod_baud(PodEnd::radio, 6, 57600),
            (Bytes{0xA5, 0x0C, 0x06, 0x04, 0x00, 0xE1, 0x00, 0x00, 0x82, 0xA4}));
  EXPECT_EQ(pack_pod_battery(7, 2048.2 / 4095.0),
            (Bytes{0xA5, 0x0D, 0x07, 0x02, 0x00, 0x08, 0x2D, 0x22}));
  EXPECT_EQ(pack_pod_battery(8, 1.5), (Bytes{0xA5, 0x0D, 0x08, 0x02, 0xFF, 0x0F, 0xAB, 0x1B}));
  EXPECT_EQ(pack_pod_cppm(7, std::array<std::uint16_t, 2>{3000, 1800}),
            (Bytes{0xA5, 0x0A, 0x07, 0x04, 0xB8, 0x0B, 0x08, 0x07, 0x84, 0xBC}));
}

// The channels of the receiver's table: all 992.
TEST(PodLink, SbusIsItsFrameWithoutStartAndEnd) {
  SbusFrame frame;
  frame.channels.fill(992);
  frame.flags = kSbusFrameLost;
  auto bytes = pack_pod_sbus(1, frame);
  ASSERT_EQ(bytes.size(), 4u + 23u + 2u);
  const std::uint8_t first[] = {0xE0, 0x03, 0x1F, 0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C};
  for (std::size_t i = 0; i < 22; ++i) EXPECT_EQ(bytes[4 + i], first[i % 11]) << i;
  EXPECT_EQ(bytes[26], 0x04);
  EXPECT_EQ(pack_pod_sbus(1, frame, true)[26], 0x84);
}

TEST(PodLink, WhatTheGpsWasToldIsRead) {
  std::vector<std::uint8_t> told;
  std::uint32_t t_us = 0;
  PodLinkReader reader([](const PodStatus&) {});
  reader.on_written(PodEnd::gps, [&](const PodWritten& written) {
    told.assign(written.bytes.begin(), written.bytes.end());
    t_us = written.t_us;
  });
  for (const int byte : {0xA5, 0x83, 0x08, 0x06, 0x40, 0x30, 0x20, 0x10, 0xB5, 0x62, 0xBD, 0xF1})
    reader.add(static_cast<std::uint8_t>(byte));
  EXPECT_EQ(told, (std::vector<std::uint8_t>{0xB5, 0x62}));
  EXPECT_EQ(t_us, 0x10203040u);
  EXPECT_EQ(reader.damaged(), 0u);
}

TEST(PodLink, WhatTheRadioWasToldIsReadAndNotTheGpss) {
  std::vector<std::uint8_t> told;
  PodLinkReader reader([](const PodStatus&) {});
  reader.on_written(PodEnd::gps, [](const PodWritten&) { ADD_FAILURE(); });
  reader.on_written(PodEnd::radio, [&](const PodWritten& written) {
    told.assign(written.bytes.begin(), written.bytes.end());
  });
  for (const int byte : {0xA5, 0x84, 0x08, 0x06, 0x40, 0x30, 0x20, 0x10, 0xFE, 0x09, 0x44, 0x67})
    reader.add(static_cast<std::uint8_t>(byte));
  EXPECT_EQ(told, (std::vector<std::uint8_t>{0xFE, 0x09}));
  EXPECT_EQ(reader.damaged(), 0u);
}

TEST(PodLink, OverCanAFrameIsItsKindSequenceAndPayload) {
  const dronecan::PodFrame message = pod_message(pack_pod_baud(PodEnd::gps, 6, 57600));
  const auto payload = dronecan::encode(message);
  const std::vector<std::uint8_t> want{0x08, 0x06, 0x00, 0xE1, 0x00, 0x00};
  EXPECT_TRUE(std::equal(payload.bytes().begin(), payload.bytes().end(), want.begin(), want.end()));
  PodLinkReader reader([](const PodStatus&) {});
  reader.add(message);  // of no kind that a pod tells
  EXPECT_EQ(reader.damaged(), 1u);
}

TEST(PodLink, ASetpointIsRead) {
  std::vector<PodSetpoint> all;
  PodLinkReader reader([](const PodStatus&) {});
  reader.on_setpoint([&](const PodSetpoint& setpoint) { all.push_back(setpoint); });
  for (const int byte : {0xA5, 0x82, 0x05, 0x04, 0x02, 0x01, 0xFF, 0x07, 0x6B, 0x13})
    reader.add(static_cast<std::uint8_t>(byte));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].esc, 2);
  EXPECT_TRUE(all[0].valid);
  EXPECT_EQ(all[0].value, 2047);
}

TEST(PodLink, AStatusIsReadFieldByField) {
  const auto all = read(kStatusFrame, 0);
  ASSERT_EQ(all.size(), 1u);
  const PodStatus& s = all[0];
  EXPECT_EQ(s.settings, (std::array<std::uint8_t, 8>{1, 1, 0, 0x18, 0x18, 1, 0x10, 0x10}));
  EXPECT_EQ(s.newest_sample, 7);
  EXPECT_EQ(s.newest_oddity, 3);
  EXPECT_TRUE(s.overdue);
  EXPECT_EQ(s.flagged, 0x80000001u);
  EXPECT_EQ((std::array{s.lost, s.late, s.damaged, s.oddities, s.overlaps, s.late_rearm}),
            (std::array<std::uint16_t, 6>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ((std::array{s.transfers, s.bursts, s.samples, s.longest_turn_us}),
            (std::array<std::uint32_t, 4>{100000, 70000, 70001, 17}));
  EXPECT_EQ(s.now_us, 0x01020304u);
  EXPECT_EQ(s.gps_dropped, 7);
  EXPECT_EQ(s.unsent, 8);
  EXPECT_EQ(s.wait_us, 0x109);
  EXPECT_EQ(s.radio_dropped, 0x20A);
}

TEST(PodFlags, EachSampleCountsOnceAndWhatNoStatusTellsIsCounted) {
  PodFlags flags;
  const auto add = [&flags](std::uint8_t newest, std::uint32_t marked) {
    PodStatus status;
    status.newest_sample = newest;
    status.flagged = marked;
    flags.add(status);
  };
  add(250, 0xFFFFFFFF);  // of before: nobody asks
  EXPECT_EQ(flags.flagged(), 0u);
  add(250, 0xFFFFFFFF);  // nothing new
  EXPECT_EQ(flags.flagged(), 0u);
  add(4, 0x00000E01);  // ten are new: bits 0 to 9
  EXPECT_EQ(flags.flagged(), 2u);
  add(36, 0x80000001);  // 32
  EXPECT_EQ(flags.flagged(), 4u);
  EXPECT_EQ(flags.untold(), 0u);
  add(86, 0x80000000);  // 50: 18 of them stand nowhere
  EXPECT_EQ(flags.flagged(), 5u);
  EXPECT_EQ(flags.untold(), 18u);
}

TEST(PodLink, AFlippedBitAnywhereCostsThatFrameOnly) {
  for (std::size_t at = 1; at < kStatusFrame.size(); ++at) {
    if (at == 3) continue;  // a wrong length swallows what follows, too
    std::vector<std::uint8_t> bytes = kStatusFrame;
    bytes[at] ^= 0x10;
    bytes.insert(bytes.end(), kStatusFrame.begin(), kStatusFrame.end());
    EXPECT_EQ(read(bytes, 1).size(), 1u) << at;
  }
}

}  // namespace
}  // namespace whirl::io

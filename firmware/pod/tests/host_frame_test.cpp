// The pod's side of its UART link, against frames typed from the layout (checksums by the catalogue's
// definition of CRC-16/MCRF4XX, the same bytes as in the host's test).
#include "firmware/pod/host_frame.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "firmware/pod/can_sample.hpp"
#include "firmware/pod/sample_watch.hpp"
#include "io_bridges/protocols/dronecan/pod_link.hpp"

namespace fw::pod {
namespace {

const std::vector<std::uint8_t> kSample{0xA5, 0x01, 0x07, 0x10, 0x34, 0x12, 0x01, 0x00,
                                        0xFE, 0xFF, 0x00, 0x08, 0xFD, 0xFF, 0x64, 0x00,
                                        0x00, 0x80, 0xFF, 0x7F, 0x5F, 0x94};

std::vector<Frame> read(const std::vector<std::uint8_t>& bytes, std::uint32_t damaged) {
  FrameReader reader;
  std::vector<Frame> all;
  for (const std::uint8_t byte : bytes) {
    if (reader.add(byte)) all.push_back(reader.frame());
  }
  EXPECT_EQ(reader.damaged(), damaged);
  return all;
}

TEST(HostFrame, ASampleIsReadLowByteFirst) {
  std::vector<std::uint8_t> bytes{0x00, 0x13};  // of no frame
  bytes.insert(bytes.end(), kSample.begin(), kSample.end());
  const auto all = read(bytes, 0);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].kind, FrameKind::sample);
  EXPECT_EQ(all[0].sequence, 7);
  EXPECT_EQ(all[0].half(0), 0x1234);
  const std::int16_t want[] = {1, -2, 2048, -3, 100, -32768, 32767};
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(all[0].word(2 + 2 * i), want[i]) << i;
}

TEST(HostFrame, AFlippedBitCostsThatFrameOnlyAndIsCounted) {
  for (std::size_t at = 1; at < kSample.size(); ++at) {
    if (at == 3) continue;  // a wrong length swallows what follows, too
    std::vector<std::uint8_t> bytes = kSample;
    bytes[at] ^= 0x01;
    bytes.insert(bytes.end(), kSample.begin(), kSample.end());
    EXPECT_EQ(read(bytes, 1).size(), 1u) << at;
  }
}

TEST(HostFrame, ALengthThatNoFrameHasIsDropped) {
  std::vector<std::uint8_t> bytes{0xA5, 0x01, 0x07, 0xFF};
  bytes.insert(bytes.end(), kSample.begin(), kSample.end());
  EXPECT_EQ(read(bytes, 1).size(), 1u);
}

TEST(HostFrame, WhatThePodWritesTheHostReads) {
  FrameWriter out(FrameKind::status, 9);
  for (const int byte : {1, 1, 0, 0x18, 0x18, 1, 0x10, 0x10, 7, 3, 1, 0}) {
    out.byte(static_cast<std::uint32_t>(byte));
  }
  out.word(0x80000001);
  for (std::uint32_t i = 1; i <= 6; ++i) out.half(i);
  for (const std::uint32_t word : {100000u, 70000u, 70001u, 17u, 123456u}) out.word(word);
  out.half(2);
  out.half(3);
  out.half(1100);
  out.half(5);
  int heard = 0;
  whirl::io::PodLinkReader host([&](const whirl::io::PodStatus& s) {
    ++heard;
    EXPECT_EQ(s.late_rearm, 6);
    EXPECT_EQ(s.bursts, 70000u);
    EXPECT_EQ(s.now_us, 123456u);
    EXPECT_EQ(s.unsent, 3);
    EXPECT_EQ(s.wait_us, 1100);
    EXPECT_EQ(s.radio_dropped, 5);
  });
  for (const std::uint8_t byte : out.finish()) host.add(byte);
  EXPECT_EQ(heard, 1);
  EXPECT_EQ(host.damaged(), 0u);
}

// 16 g are 32768 steps: at a range of 8 g (2) twice as many counts, and no more than there are.
TEST(CanSample, StepsOfTheWidestRangeAreCountsOfThePartsOwn) {
  EXPECT_EQ(part_counts(1000, 3), 1000);
  EXPECT_EQ(part_counts(-1000, 2), -2000);
  EXPECT_EQ(part_counts(1000, 0), 8000);
  EXPECT_EQ(part_counts(20000, 2), 32767);
  EXPECT_EQ(part_counts(-20000, 2), -32768);
}

TEST(CanSample, AStampNumbersItsSampleByMilliseconds) {
  StampCounter stamps;
  const std::uint8_t first = stamps.number(4000, 1u << 12);
  const std::uint16_t begin_us = stamps.now_us();
  EXPECT_EQ(stamps.number(4004, 1u << 12), first);     // once more
  EXPECT_EQ(stamps.number(4, 1u << 12), first + 1);    // round, 0.96 ms later
  EXPECT_EQ(stamps.number(208, 1u << 12), first + 3);  // one is missing
  EXPECT_EQ(static_cast<std::uint16_t>(stamps.now_us() - begin_us), 40 + 960 + 2040);
}

TEST(SampleWatch, ALostSampleIsFlaggedInItsPlace) {
  SampleWatch watch;
  watch.came(254, 0, false);
  watch.came(255, 1000, false);
  watch.came(1, 3000, false);  // 0 never came
  watch.came(2, 4000, false);
  EXPECT_EQ(watch.lost(), 1u);
  EXPECT_EQ(watch.late(), 0u);
  EXPECT_EQ(watch.flagged(), 0b100u);
}

TEST(SampleWatch, ALateOneIsFlaggedItself) {
  SampleWatch watch;
  watch.came(1, 3000, false);
  EXPECT_FALSE(watch.overdue(0));
  EXPECT_FALSE(watch.overdue(4250));
  EXPECT_TRUE(watch.overdue(4251));
  watch.came(2, 4000, true);
  watch.came(3, 5000, false);
  EXPECT_EQ(watch.lost(), 0u);
  EXPECT_EQ(watch.late(), 1u);
  EXPECT_EQ(watch.flagged(), 0b10u);
}

}  // namespace
}  // namespace fw::pod

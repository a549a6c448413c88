// Writing to the card: tokens, checks, the time it takes, and what a lost supply leaves.
#include <gtest/gtest.h>

#include <algorithm>

#include "io_bridges/devices/tests/sd_card_bench.hpp"

namespace whirl::io {
namespace {

using Bytes = CardBench::Bytes;

constexpr int kAccepted = 0x05, kCrcError = 0x0B, kWriteError = 0x0D;

TEST(SdCardWrite, ManyBlocksFollowOneAnotherUntilTheStopToken) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  bench.command(bench.at(55, 0));
  EXPECT_EQ(bench.command(bench.at(23, 3)), Bytes{0x00});
  ASSERT_EQ(bench.command(bench.at(25, 1000)), Bytes{0x00});
  for (std::uint8_t i = 1; i <= 3; ++i) {
    EXPECT_EQ(bench.send_block(0xFC, CardBench::filled(i)), kAccepted);
    bench.busy();
  }
  bench.clock(0xFD);
  bench.clock();
  EXPECT_GT(bench.busy(), 10'000);
  for (std::uint8_t i = 1; i <= 3; ++i) {
    EXPECT_EQ(bench.read_block(999u + i), CardBench::filled(i));
  }
  EXPECT_EQ(bench.read_block(1003), CardBench::filled(0));
  EXPECT_TRUE(bench.findings.empty());
}

TEST(SdCardWrite, ChecksTheCrcOfDataOnlyWhenItIsOn) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  ASSERT_EQ(bench.command(bench.at(24, 1)), Bytes{0x00});
  EXPECT_EQ(bench.send_block(0xFE, CardBench::filled(0xFF), 0x0000), kAccepted);
  bench.busy();
  bench.command({0x7B, 0, 0, 0, 1, 0x83});
  ASSERT_EQ(bench.command({0x58, 0x12, 0x34, 0x56, 0x78, 0x67}), Bytes{0x40});  // beyond the end
  ASSERT_EQ(bench.command({0x58, 0, 0, 0, 0, 0x6F}), Bytes{0x00});
  EXPECT_EQ(bench.send_block(0xFE, CardBench::filled(0xFF), 0x7FA0), kCrcError);
  EXPECT_EQ(bench.clock(), 0xFF);  // nothing is programmed
  ASSERT_EQ(bench.command({0x58, 0, 0, 0, 0, 0x6F}), Bytes{0x00});
  EXPECT_EQ(bench.send_block(0xFE, CardBench::filled(0xFF), 0x7FA1), kAccepted);
  bench.busy();
  ASSERT_EQ(bench.command({0x51, 0, 0, 0, 0, 0x55}), Bytes{0x00});
  EXPECT_EQ(bench.data(512), CardBench::filled(0xFF));
  EXPECT_EQ(bench.crc, (Bytes{0x7F, 0xA1}));
}

TEST(SdCardWrite, IsBusyAlsoAfterItWasDeselectedAndIgnoresCommands) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  ASSERT_EQ(bench.command(bench.at(24, 7)), Bytes{0x00});
  EXPECT_EQ(bench.send_block(0xFE, CardBench::filled(0x42)), kAccepted);
  EXPECT_EQ(bench.clock(), 0x00);
  bench.select(false);
  EXPECT_EQ(bench.clock(), 0xFF);  // it lets go of the line
  bench.select(true);
  EXPECT_EQ(bench.clock(), 0x00);
  bench.clock(bench.at(13, 0));
  EXPECT_EQ(bench.findings.size(), 1u);
  bench.busy();
  EXPECT_EQ(bench.command(bench.at(13, 0), 1), (Bytes{0x00, 0x00}));
  EXPECT_EQ(bench.read_block(7), CardBench::filled(0x42));
}

TEST(SdCardWrite, ABlockThatIsNotSentWholeIsNotWritten) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  ASSERT_EQ(bench.command(bench.at(24, 7)), Bytes{0x00});
  bench.clock(0xFE);
  bench.clock(Bytes(300, 0x11));
  bench.select(false);
  bench.clock();
  bench.select(true);
  EXPECT_EQ(bench.read_block(7), CardBench::filled(0));
}

TEST(SdCardWrite, TimesHaveTwoPeaks) {
  SdCard::Params params = CardBench::quick();
  params.stall_every = 50.0;
  CardBench bench(params);
  ASSERT_TRUE(bench.start());
  std::vector<Nanoseconds> times;
  for (std::uint32_t i = 0; i < 1500; ++i) {
    bench.command(bench.at(24, i));
    bench.send_block(0xFE, CardBench::filled(1));
    times.push_back(bench.busy());
  }
  std::sort(times.begin(), times.end());
  const auto stalls =
      std::count_if(times.begin(), times.end(), [](Nanoseconds t) { return t > 2'000'000; });
  EXPECT_GE(stalls, 15);  // 30, and three standard deviations of 5.4 about it
  EXPECT_LE(stalls, 46);
  EXPECT_GE(times.front(), 490'000);
  EXPECT_LE(times[times.size() / 2], 1'200'000);
  EXPECT_GE(times[times.size() / 2], 800'000);
  EXPECT_GT(times.back(), 100'000'000);
  EXPECT_LE(times.back(), 250'001'000);
}

TEST(SdCardWrite, AWriteErrorKeepsTheOldBlockAndShowsInTheStatusAndTheCount) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  ASSERT_EQ(bench.command(bench.at(25, 20)), Bytes{0x00});
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(bench.send_block(0xFC, CardBench::filled(9)), kAccepted);
    bench.busy();
  }
  bench.add(FaultKind::memory_write_error, bench.now_ms(), bench.now_ms() + 1.0);
  EXPECT_EQ(bench.send_block(0xFC, CardBench::filled(9)), kWriteError);
  bench.run_ms(2.0);
  EXPECT_EQ(bench.send_block(0xFC, CardBench::filled(9)), kWriteError);  // until it is stopped
  bench.clock(0xFD);
  bench.clock();
  bench.busy();
  EXPECT_EQ(bench.command(bench.at(13, 0), 1), (Bytes{0x00, 0x04}));
  bench.command(bench.at(55, 0));
  ASSERT_EQ(bench.command(bench.at(22, 0)), Bytes{0x00});
  EXPECT_EQ(bench.data(4), (Bytes{0, 0, 0, 2}));
  EXPECT_EQ(bench.read_block(21), CardBench::filled(9));
  EXPECT_EQ(bench.read_block(22), CardBench::filled(0));
}

TEST(SdCardWrite, ACrcFaultSpoilsBothDirections) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  bench.add(FaultKind::memory_crc_error, 0.0, bench.now_ms() + 3.0);
  ASSERT_EQ(bench.command(bench.at(24, 1)), Bytes{0x00});
  EXPECT_EQ(bench.send_block(0xFE, CardBench::filled(1)), kCrcError);
  const auto spoiled = bench.read_block(1);
  ASSERT_TRUE(spoiled);
  EXPECT_NE(*spoiled, CardBench::filled(0));
  EXPECT_EQ(bench.crc, (Bytes{0, 0}));  // of what was meant
  bench.run_ms(4.0);
  EXPECT_EQ(bench.read_block(1), CardBench::filled(0));
}

TEST(SdCardWrite, AStuckCardIsBusyUntilTheFaultEnds) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  const double from_ms = bench.now_ms();
  bench.add(FaultKind::memory_busy, from_ms, from_ms + 400.0);
  bench.command(bench.at(24, 1));
  EXPECT_EQ(bench.send_block(0xFE, CardBench::filled(1)), kAccepted);
  EXPECT_GT(bench.busy(), 390'000'000);
  EXPECT_EQ(bench.read_block(1), CardBench::filled(1));
}

TEST(SdCardWrite, APulledCardIsSilentAndComesBackInSdMode) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  bench.write_block(3, CardBench::filled(3));
  bench.add(FaultKind::memory_removed, bench.now_ms(), bench.now_ms() + 50.0);
  bench.run_ms(1.0);
  EXPECT_TRUE(bench.command(bench.at(13, 0)).empty());
  EXPECT_EQ(bench.read_bytes(3), Bytes(3, 0xFF));
  bench.run_ms(60.0);
  EXPECT_TRUE(bench.command(bench.at(13, 0)).empty());  // there, but not on SPI
  ASSERT_TRUE(bench.start());
  EXPECT_EQ(bench.read_block(3), CardBench::filled(3));
  EXPECT_TRUE(bench.faults.pending().empty());
}

// Of many cards each outcome comes: the block old, new, or unreadable until it is written again.
TEST(SdCardWrite, ACutSupplyLeavesTheBlockOldNewOrUnreadable) {
  int old = 0, fresh = 0, unreadable = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SdCard::Params params = CardBench::quick();
    params.seed = seed;
    CardBench bench(params);
    ASSERT_TRUE(bench.start());
    for (std::uint32_t i = 0; i < 3; ++i) bench.write_block(i, CardBench::filled(0x11));
    bench.add(FaultKind::memory_cut, 0.0, bench.now_ms() + 20.0, 0.5);
    bench.command(bench.at(24, 1));
    EXPECT_EQ(bench.send_block(0xFE, CardBench::filled(0x22)), kAccepted);
    bench.run_ms(30.0);
    ASSERT_TRUE(bench.start());
    EXPECT_EQ(bench.read_block(0), CardBench::filled(0x11));
    EXPECT_EQ(bench.read_block(2), CardBench::filled(0x11));
    const auto got = bench.read_block(1);
    if (!got) {
      ++unreadable;
      EXPECT_EQ(bench.token, 0x04);
      EXPECT_EQ(bench.command(bench.at(13, 0), 1), (Bytes{0x00, 0x10}));
      bench.write_block(1, CardBench::filled(0x33));
      EXPECT_EQ(bench.read_block(1), CardBench::filled(0x33));
    } else {
      (*got == CardBench::filled(0x11) ? old : fresh) += 1;
      EXPECT_TRUE(*got == CardBench::filled(0x11) || *got == CardBench::filled(0x22));
    }
  }
  for (const int count : {old, fresh, unreadable}) EXPECT_GE(count, 4);
}

TEST(SdCardWrite, WithTheCardGoesWhatItWasWriting) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  bench.add(FaultKind::memory_removed, bench.now_ms() + 0.5, bench.now_ms() + 5.0);
  bench.command(bench.at(24, 1));
  bench.send_block(0xFE, CardBench::filled(0x22));
  EXPECT_LT(bench.busy(), 500'000);  // "ready" at once: the line has floated high
  EXPECT_TRUE(bench.command(bench.at(13, 0)).empty());
}

}  // namespace
}  // namespace whirl::io

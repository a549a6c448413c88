// The card by the specification's golden commands: start-up, identity, reading.
#include "io_bridges/devices/sd_card.hpp"

#include <gtest/gtest.h>

#include "io_bridges/devices/tests/sd_card_bench.hpp"

namespace whirl::io {
namespace {

using Bytes = CardBench::Bytes;

const Bytes kCmd0{0x40, 0, 0, 0, 0, 0x95}, kCmd8{0x48, 0, 0, 0x01, 0xAA, 0x87},
    kCmd55{0x77, 0, 0, 0, 0, 0x65}, kCmd58{0x7A, 0, 0, 0, 0, 0xFD};

TEST(SdCard, HearsNothingBeforeSeventyFourClocksWithChipSelectHigh) {
  CardBench bench;
  bench.run_ms(2.0);
  bench.read_bytes(9);  // 72
  bench.select(true);
  EXPECT_TRUE(bench.command(kCmd0).empty());
  EXPECT_EQ(bench.findings.size(), 1u);
  bench.select(false);
  bench.read_bytes(1);  // 80
  bench.select(true);
  EXPECT_EQ(bench.command(kCmd0), Bytes{0x01});
}

TEST(SdCard, ClocksDoNotCountInItsFirstMillisecond) {
  CardBench bench;
  bench.read_bytes(20);
  bench.select(true);
  EXPECT_TRUE(bench.command(kCmd0).empty());
}

TEST(SdCard, ChecksTheCrcOfTheFirstTwoCommands) {
  CardBench bench;
  bench.power_up();
  EXPECT_TRUE(bench.command({0x40, 0, 0, 0, 0, 0x97}).empty());
  EXPECT_EQ(bench.command(kCmd0), Bytes{0x01});
  EXPECT_EQ(bench.command({0x48, 0, 0, 0x01, 0xAA, 0x85}), Bytes{0x09});
  EXPECT_EQ(bench.command(kCmd8, 4), (Bytes{0x01, 0, 0, 0x01, 0xAA}));
  EXPECT_EQ(bench.command({0x48, 0, 0, 0x01, 0xAB, 0x95}, 4), (Bytes{0x01, 0, 0, 0x01, 0xAB}));
}

TEST(SdCard, StartsAsTheSpecificationsFlowChartSays) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  EXPECT_EQ(bench.command(kCmd58, 4), (Bytes{0x00, 0xC0, 0xFF, 0x80, 0x00}));
  ASSERT_EQ(bench.command(bench.at(9, 0)), Bytes{0x00});
  EXPECT_EQ(bench.data(16), (Bytes{0x40, 0x0E, 0, 0x32, 0x5B, 0x59, 0, 0, 0, 0x7F, 0x7F, 0x80, 0x0A,
                                   0x40, 0, 0x51}));  // 64 MiB
  EXPECT_EQ(bench.crc, (Bytes{0xC0, 0x01}));
  EXPECT_TRUE(bench.findings.empty());
}

TEST(SdCard, TheOcrSaysThatItIsNotReadyYet) {
  CardBench bench;
  bench.power_up();
  bench.command(kCmd0);
  EXPECT_EQ(bench.command(kCmd58, 4), (Bytes{0x01, 0x00, 0xFF, 0x80, 0x00}));
}

TEST(SdCard, AHighCapacityCardStaysIdleForAHostThatDoesNotKnowIt) {
  CardBench without_hcs;
  EXPECT_FALSE(without_hcs.start(false));
  EXPECT_FALSE(without_hcs.findings.empty());

  CardBench without_cmd8;
  without_cmd8.power_up();
  without_cmd8.command(kCmd0);
  for (int i = 0; i < 100; ++i) {
    without_cmd8.command(kCmd55);
    EXPECT_EQ(without_cmd8.command({0x69, 0x40, 0, 0, 0, 0x77}), Bytes{0x01});
    without_cmd8.run_ms(5.0);
  }
}

TEST(SdCard, BeforeItIsReadyItTakesNoOtherCommand) {
  CardBench bench;
  bench.power_up();
  bench.command(kCmd0);
  for (const std::uint8_t index : {9, 12, 13, 17, 24, 32}) {
    EXPECT_EQ(bench.command(bench.at(index, 0)), Bytes{0x05}) << int{index};
  }
}

TEST(SdCard, WhatItDoesNotKnowIsIllegalAndAFinding) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  for (const std::uint8_t index : {6, 27, 28, 42, 56, 63}) {
    EXPECT_EQ(bench.command(bench.at(index, 0)), Bytes{0x04}) << int{index};
  }
  EXPECT_EQ(bench.findings.size(), 6u);
}

TEST(SdCard, ChecksEveryCommandOnceCrcIsOn) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  EXPECT_EQ(bench.command(bench.at(13, 0), 1), (Bytes{0x00, 0x00}));
  EXPECT_EQ(bench.command({0x7B, 0, 0, 0, 1, 0x83}), Bytes{0x00});
  EXPECT_EQ(bench.command(bench.at(13, 0)), Bytes{0x08});
  EXPECT_EQ(bench.command({0x4D, 0, 0, 0, 0, 0x0D}, 1), (Bytes{0x00, 0x00}));
  EXPECT_EQ(bench.command({0x51, 0, 0, 0, 0, 0x55}), Bytes{0x00});
  EXPECT_EQ(bench.data(512), CardBench::filled(0));
  EXPECT_EQ(bench.crc, (Bytes{0, 0}));
  EXPECT_EQ(bench.command({0x7B, 0, 0, 0, 0, 0x91}), Bytes{0x00});
  EXPECT_EQ(bench.command(bench.at(13, 0), 1), (Bytes{0x00, 0x00}));
}

TEST(SdCard, StandardCapacityCountsInBytesAndRefusesOddAddresses) {
  SdCard::Params params = CardBench::quick();
  params.high_capacity = false;
  CardBench bench(params);
  ASSERT_TRUE(bench.start(false));
  EXPECT_EQ(bench.command(kCmd58, 4), (Bytes{0x00, 0x80, 0xFF, 0x80, 0x00}));
  EXPECT_EQ(bench.command({0x50, 0, 0, 0x02, 0x00, 0x15}), Bytes{0x00});
  EXPECT_EQ(bench.command(bench.at(16, 100)), Bytes{0x40});
  EXPECT_EQ(bench.write_block(5 * 512, CardBench::filled(0x5A)), 0x05);
  EXPECT_EQ(bench.read_block(5 * 512), CardBench::filled(0x5A));
  EXPECT_EQ(bench.command(bench.at(17, 5 * 512 + 1)), Bytes{0x20});
}

TEST(SdCard, ReadsManyBlocksUntilItIsStopped) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  for (std::uint8_t i = 0; i < 4; ++i) bench.write_block(100 + i, CardBench::filled(i));
  ASSERT_EQ(bench.command(bench.at(18, 100)), Bytes{0x00});
  for (std::uint8_t i = 0; i < 3; ++i) EXPECT_EQ(bench.data(512), CardBench::filled(i));
  bench.clock(Bytes{0x4C, 0, 0, 0, 0, 0x61});
  bench.clock();  // to be discarded
  int polls = 0;
  while (bench.clock() != 0x00) ASSERT_LT(++polls, 9);
  EXPECT_EQ(bench.busy(), 8'000'000'000LL / bench.sck_Hz);  // ready at once
  EXPECT_EQ(bench.read_block(103), CardBench::filled(3));
}

TEST(SdCard, BeyondItsEndThereIsNothing) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  const auto last = static_cast<std::uint32_t>(bench.card.blocks() - 1);
  EXPECT_EQ(bench.command(bench.at(17, last + 1)), Bytes{0x40});
  EXPECT_EQ(bench.command(bench.at(13, 0), 1), (Bytes{0x00, 0x80}));
  EXPECT_EQ(bench.command(bench.at(13, 0), 1), (Bytes{0x00, 0x00}));  // reading cleared it
  ASSERT_EQ(bench.command(bench.at(18, last)), Bytes{0x00});
  EXPECT_TRUE(bench.data(512));
  EXPECT_FALSE(bench.data(512));
  EXPECT_EQ(bench.token, 0x08);
}

TEST(SdCard, ErasedBlocksReadZeroAndTheirNeighboursStay) {
  CardBench bench;
  ASSERT_TRUE(bench.start());
  for (std::uint32_t i = 0; i < 5; ++i) bench.write_block(10 + i, CardBench::filled(0x77));
  EXPECT_EQ(bench.command(bench.at(38, 0)), Bytes{0x10});  // without its two addresses
  EXPECT_EQ(bench.command(bench.at(32, 11)), Bytes{0x00});
  EXPECT_EQ(bench.command(bench.at(33, 13)), Bytes{0x00});
  EXPECT_EQ(bench.command(bench.at(38, 0)), Bytes{0x00});
  EXPECT_GT(bench.busy(), 1'000'000);
  for (std::uint32_t i = 0; i < 5; ++i) {
    EXPECT_EQ(bench.read_block(10 + i), CardBench::filled(i == 0 || i == 4 ? 0x77 : 0)) << i;
  }
}

TEST(SdCard, TooFastAClockIsAFinding) {
  CardBench bench;
  bench.power_up();
  bench.sck_Hz = 1'000'000;
  bench.command(kCmd0);
  EXPECT_EQ(bench.findings.size(), 1u);
  CardBench ready;
  ASSERT_TRUE(ready.start());
  ready.read_block(0);
  EXPECT_TRUE(ready.findings.empty());
  ready.sck_Hz = 42'000'000;
  ready.read_block(0);
  EXPECT_EQ(ready.findings.size(), 1u);
}

TEST(SdCard, EachCardHasItsOwnNumberAndPaceOfAnswering) {
  std::set<Bytes> identities;
  std::set<int> paces;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SdCard::Params params = CardBench::quick();
    params.seed = seed;
    CardBench bench(params);
    ASSERT_TRUE(bench.start()) << seed;
    bench.clock(bench.at(10, 0));
    int pace = 0;
    while (bench.clock() != 0x00) ASSERT_LT(++pace, 9);
    paces.insert(pace);
    identities.insert(bench.data(16).value());
  }
  EXPECT_EQ(identities.size(), 12u);
  EXPECT_GT(paces.size(), 3u);
}

TEST(SdCard, AMultiMediaCardKnowsNeitherCmd8NorCmd55) {
  CardBench bench;
  bench.add(FaultKind::sensor_wrong_identity, 0.0, 1e6);
  bench.power_up();
  EXPECT_EQ(bench.command(kCmd0), Bytes{0x01});
  EXPECT_EQ(bench.command(kCmd8), Bytes{0x05});
  EXPECT_EQ(bench.command(kCmd55), Bytes{0x05});
}

}  // namespace
}  // namespace whirl::io

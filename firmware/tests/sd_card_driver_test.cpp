// The card driver against the card's model; they share no header.
#include <gtest/gtest.h>

#include "firmware/tests/card_rig.hpp"

namespace fw {
namespace {

using Block = std::array<std::uint8_t, 512>;
using io::FaultKind;

Block filled(std::uint8_t byte) {
  Block block{};
  block.fill(byte);
  return block;
}
Status write(CardRig& rig, std::uint32_t at, const Block& block) {
  return rig.until_done(rig.card.write(at, block));
}
Block read(CardRig& rig, std::uint32_t at) {
  Block block{};
  EXPECT_EQ(rig.until_done(rig.card.read(at, block)), Status::ok);
  return block;
}

TEST(SdWire, CrcsAreTheSpecifications) {
  sd::Frame frame{};
  sd::put_command(frame, 0, 0);
  EXPECT_EQ(frame[6], 0x95);
  sd::put_command(frame, 8, 0x1AA);
  EXPECT_EQ(frame[6], 0x87);
  sd::put_block(frame, filled(0xFF));
  EXPECT_EQ(frame[514], 0x7F);
  EXPECT_EQ(frame[515], 0xA1);
}

TEST(SdCardDriver, StartsHighCapacityAndStandardCards) {
  for (const bool high_capacity : {true, false}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {  // of every pace
      io::SdCard::Params params = CardRig::quick();
      params.high_capacity = high_capacity;
      params.seed = seed;
      CardRig rig(params);
      ASSERT_TRUE(rig.until_ready(500.0));
      EXPECT_EQ(rig.card.blocks(), 131072u);
      EXPECT_EQ(write(rig, 77, filled(9)), Status::ok);
      EXPECT_EQ(read(rig, 77), filled(9));
      EXPECT_TRUE(rig.findings.empty()) << rig.findings[0];
    }
  }
}

TEST(SdCardDriver, WritesThatFollowOneAnotherAreOneStream) {
  CardRig rig;
  ASSERT_TRUE(rig.until_ready(500.0));
  for (std::uint8_t i = 0; i < 50; ++i) EXPECT_EQ(write(rig, 1000u + i, filled(i)), Status::ok);
  EXPECT_EQ(rig.commands[25], 1);
  EXPECT_EQ(rig.until_done(rig.card.finish()), Status::ok);
  EXPECT_EQ(write(rig, 500, filled(0x55)), Status::ok);
  EXPECT_EQ(write(rig, 500, filled(0x66)), Status::ok);  // the same again: another stream
  EXPECT_EQ(rig.commands[25], 3);
  for (std::uint8_t i = 0; i < 50; ++i) EXPECT_EQ(read(rig, 1000u + i), filled(i));
  EXPECT_EQ(read(rig, 500), filled(0x66));
  EXPECT_TRUE(rig.findings.empty()) << rig.findings[0];
}

TEST(SdCardDriver, MovesNoMoreThanABlockInATick) {
  CardRig rig;
  ASSERT_TRUE(rig.until_ready(500.0));
  for (std::uint8_t i = 0; i < 20; ++i) EXPECT_EQ(write(rig, i, filled(i)), Status::ok);
  read(rig, 3);
  EXPECT_LE(rig.most_moved, SdCard<CardRig::Bus>::kMost_bytes_per_tick);
  EXPECT_GE(rig.most_moved, 517u);
}

TEST(SdCardDriver, ErasesARange) {
  CardRig rig;
  ASSERT_TRUE(rig.until_ready(500.0));
  for (std::uint32_t i = 0; i < 6; ++i) EXPECT_EQ(write(rig, i, filled(7)), Status::ok);
  EXPECT_EQ(rig.until_done(rig.card.erase(1, 4)), Status::ok);
  for (std::uint32_t i = 0; i < 6; ++i) EXPECT_EQ(read(rig, i), filled(i == 0 || i == 5 ? 7 : 0));
}

TEST(SdCardDriver, AskedForTooMuchItSaysSo) {
  CardRig rig;
  Block block{};
  EXPECT_EQ(rig.card.read(0, block), Status::no_answer);
  ASSERT_TRUE(rig.until_ready(500.0));
  EXPECT_EQ(rig.card.read(131072, block), Status::bad_data);
  EXPECT_EQ(rig.card.read(0, block), Status::ok);
  EXPECT_EQ(rig.card.write(0, block), Status::busy);
}

TEST(SdCardDriver, LivesThroughTheLongestStall) {
  io::SdCard::Params params = CardRig::quick();
  params.stall_every = 1.0;  // each block
  params.longest_stall_ns = 500'000'000;
  CardRig rig(params);
  ASSERT_TRUE(rig.until_ready(500.0));
  for (std::uint8_t i = 0; i < 10; ++i) EXPECT_EQ(write(rig, i, filled(i)), Status::ok);
  EXPECT_EQ(rig.until_done(rig.card.finish()), Status::ok);
  EXPECT_EQ(rig.card.failures(), 0u);
}

TEST(SdCardDriver, APulledCardFailsTheRequestAndOnePutInStartsAnew) {
  CardRig rig;
  ASSERT_TRUE(rig.until_ready(500.0));
  EXPECT_EQ(write(rig, 0, filled(1)), Status::ok);
  rig.add(FaultKind::memory_removed, rig.now_ms(), rig.now_ms() + 1000.0);
  rig.tick();
  std::uint32_t at = 1;
  while (write(rig, at, filled(2)) == Status::ok) ASSERT_LT(++at, 4u);
  EXPECT_FALSE(rig.card.ready());
  EXPECT_FALSE(rig.until_ready(900.0));
  EXPECT_TRUE(rig.until_ready(1000.0));
  EXPECT_EQ(rig.card.starts(), 2u);
  EXPECT_EQ(read(rig, 0), filled(1));
}

TEST(SdCardDriver, RefusedBlocksFailTheirRequest) {
  for (const FaultKind kind : {FaultKind::memory_write_error, FaultKind::memory_crc_error}) {
    CardRig rig;
    ASSERT_TRUE(rig.until_ready(500.0));
    rig.add(kind, rig.now_ms(), rig.now_ms() + 20.0);
    EXPECT_EQ(write(rig, 5, filled(1)), Status::bad_data);
    EXPECT_EQ(rig.card.failures(), 1u);
    rig.queue.run_until(rig.queue.now() + 20'000'000);
    ASSERT_TRUE(rig.until_ready(1000.0));
    EXPECT_EQ(read(rig, 5), filled(0));
    EXPECT_EQ(write(rig, 5, filled(1)), Status::ok);
  }
}

TEST(SdCardDriver, ABitLostOnTheWireIsNoticed) {
  CardRig rig;
  ASSERT_TRUE(rig.until_ready(500.0));
  rig.add(FaultKind::memory_crc_error, rig.now_ms(), rig.now_ms() + 5.0);
  Block block{};
  EXPECT_EQ(rig.until_done(rig.card.read(0, block)), Status::bad_data);
}

TEST(SdCardDriver, ABlockThatTheCardCannotReadIsBadData) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    io::SdCard::Params params = CardRig::quick();
    params.seed = seed;
    CardRig rig(params);
    ASSERT_TRUE(rig.until_ready(500.0));
    rig.add(FaultKind::memory_cut, rig.now_ms(), rig.now_ms() + 50.0, 0.5);
    std::ignore = write(rig, 9, filled(0xAB));
    rig.queue.run_until(rig.queue.now() + 60'000'000);
    Block block{};
    std::ignore = rig.until_done(rig.card.read(9, block));  // notices that the card has gone
    ASSERT_TRUE(rig.until_ready(2000.0));
    const Status status = rig.until_done(rig.card.read(9, block));
    if (status == Status::bad_data) return;  // a third of the cards
  }
  FAIL() << "no card had an unreadable block";
}

TEST(SdCardDriver, ACardThatStaysBusyIsGivenUpAfterSixHundredMilliseconds) {
  CardRig rig;
  ASSERT_TRUE(rig.until_ready(500.0));
  rig.add(FaultKind::memory_busy, rig.now_ms(), rig.now_ms() + 3000.0);
  const double from_ms = rig.now_ms();
  EXPECT_EQ(write(rig, 5, filled(1)), Status::no_answer);
  EXPECT_GE(rig.now_ms() - from_ms, 600.0);
  EXPECT_LE(rig.now_ms() - from_ms, 610.0);
}

TEST(SdCardDriver, AMultiMediaCardIsTheWrongPart) {
  CardRig rig;
  rig.add(FaultKind::sensor_wrong_identity, 0.0, -1.0);
  EXPECT_FALSE(rig.until_ready(1000.0));
  EXPECT_EQ(rig.card.result(), Status::wrong_id);
}

TEST(SdCardDriver, WithoutACardItGoesOnAsking) {
  CardRig rig;
  rig.add(FaultKind::memory_removed, 0.0, 5000.0);
  EXPECT_FALSE(rig.until_ready(4900.0));
  EXPECT_TRUE(rig.until_ready(1000.0));
  EXPECT_EQ(rig.card.failures(), 0u);
}

// A bus that works in the background: nothing is taken from it before it says that it is done.
struct SlowBus {
  explicit SlowBus(CardRig& on) : direct{on} {}
  void select(bool on) { direct.select(on); }
  Status start(std::span<std::uint8_t> bytes, bool fast) {
    if (left > 0) return Status::busy;
    given = bytes;
    was_fast = fast;
    left = 3;
    return Status::ok;
  }
  bool done() {
    if (left == 0) return true;
    if (--left == 0) std::ignore = direct.start(given, was_fast);
    return left == 0;
  }
  CardRig::Bus direct;
  std::span<std::uint8_t> given{};
  bool was_fast = false;
  int left = 0;
};

TEST(SdCardDriver, WaitsForABusThatWorksInTheBackground) {
  CardRig rig;
  SlowBus bus(rig);
  SdCard<SlowBus> card(bus);
  const auto run = [&](auto until) {
    for (int i = 0; !until() && i < 100'000; ++i) {
      rig.queue.run_until(rig.queue.now() + 100'000);
      card.tick(rig.now_us());
    }
    return until();
  };
  ASSERT_TRUE(run([&] { return card.ready(); }));
  ASSERT_EQ(card.write(3, filled(0x31)), Status::ok);
  ASSERT_TRUE(run([&] { return !card.busy(); }));
  Block block{};
  ASSERT_EQ(card.read(3, block), Status::ok);
  ASSERT_TRUE(run([&] { return !card.busy(); }));
  EXPECT_EQ(block, filled(0x31));
}

}  // namespace
}  // namespace fw

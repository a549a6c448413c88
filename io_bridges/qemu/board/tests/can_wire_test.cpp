// A CAN bus that three boards have, against the same nodes on one bus: whatever they send, whenever they come and go, and
// whatever is wrong with the wire, all that any of them is told is the same to the nanosecond.
#include <gtest/gtest.h>

#include <random>

#include "io_bridges/qemu/board/tests/can_boards.hpp"

namespace whirl::board {
namespace {

using io::FaultKind;

// The same on both; how many frames there were.
std::size_t same(const Script& script) {
  const Seen one = on_one_bus(script), joined = ThreeBoards(script).seen();
  EXPECT_EQ(joined.log, one.log);
  for (std::size_t n = 0; n < kNodes; ++n) {
    EXPECT_EQ(joined.told[n], one.told[n]) << "node " << n;
    EXPECT_EQ(joined.counters[n], one.counters[n]) << "node " << n;
  }
  EXPECT_EQ(joined.findings, one.findings);
  return one.log.size();
}

Script all_there() {
  Script script;
  for (std::size_t n = 0; n < kNodes; ++n) script.come(n, 0);
  return script;
}

std::string line_of(const std::vector<std::string>& log, std::size_t k) {
  return k < log.size() ? log[k] : "";
}

// Of two that begin at one nanosecond on two boards, and a third one within the same bit, which finds the bus taken.
TEST(JoinedCan, TheLowerIdentifierOfTwoBoardsGoesFirst) {
  Script script = all_there();
  script.send(2, 100'000, 0x300, 2);
  script.send(4, 100'000, 0x200, 2);
  script.send(0, 100'400, 0x100, 2);
  EXPECT_EQ(same(script), 3u);
  const auto log = ThreeBoards(script).seen().log;
  EXPECT_NE(line_of(log, 0).find("id 512 from 2 error 0 bit 0 losers 1"), std::string::npos);
  EXPECT_NE(line_of(log, 1).find("id 256 from -1"), std::string::npos);
  EXPECT_NE(line_of(log, 2).find("id 768 from 1"), std::string::npos);
}

// And it is still known which is its own: it asks for something else while the first is on the wire.
TEST(JoinedCan, ABoardThatSendsAsksMeanwhile) {
  Script script = all_there();
  for (int k = 0; k < 6; ++k)
    script.send(2, 100'000 + 10'000 * k, 0x300u - static_cast<unsigned>(k), 8);
  script.drop(2, 500'000);
  script.send(3, 500'001, 0x50);
  EXPECT_GT(same(script), 3u);
}

// A core may go on in the nanosecond in which its board was answered.
TEST(JoinedCan, ABoardAsksAgainWhenItWasAnswered) {
  Script script = all_there();
  script.go(3, 200'000);
  script.come(3, 300'000);  // is answered
  script.send(2, 300'000, 0x200, 1);
  script.deeds.back().rank = io::Rank::boundary;
  EXPECT_EQ(same(script), 1u);
  EXPECT_EQ(line_of(ThreeBoards(script).seen().log, 0).substr(0, 7), "300000 ");
}

// What it does not get it has read, and its counter says so.
TEST(JoinedCan, AFrameThatIsLostCounts) {
  Script script = all_there();
  script.fault(FaultKind::can_bit_error, 0, io::kNever, 1.0, 0);
  script.fault(FaultKind::can_lost, 0, io::kNever, 0.0, 1);
  script.send(1, 100'000, 0x200, 1);
  EXPECT_EQ(same(script), 2u);
  EXPECT_EQ(ThreeBoards(script).seen().counters[2], "0 0 on");
}

TEST(JoinedCan, ABoardAloneHasNobodyWhoAcknowledges) {
  Script script;
  script.come(4, 10'000);
  script.send(4, 50'000, 0x123, 1);
  EXPECT_GT(same(script), 16u);  // it is passive by then
  const auto seen = ThreeBoards(script).seen();
  EXPECT_NE(line_of(seen.log, 0).find("error 3"), std::string::npos) << line_of(seen.log, 0);
  EXPECT_EQ(seen.counters[4], "128 0 on");
}

TEST(JoinedCan, AnotherBoardAcknowledges) {
  Script script;
  script.come(4, 10'000);
  script.come(2, 10'000);
  script.send(4, 50'000, 0x123, 1);
  EXPECT_EQ(same(script), 1u);
}

TEST(JoinedCan, OneThatLosesEachBitGoesBusOffAndComesBack) {
  Script script = all_there();
  script.grains = 12;
  script.fault(FaultKind::can_bit_error, 0, 4'000'000, 0.0, 1);
  script.send(2, 100'000, 0x100);
  script.send(4, 2'000'000, 0x400);
  EXPECT_GT(same(script), 32u);
  const auto seen = ThreeBoards(script).seen();
  EXPECT_NE(seen.told[2].find("bus-off"), std::string::npos);
  EXPECT_NE(seen.told[2].find("joined", seen.told[2].find("bus-off")), std::string::npos);
}

TEST(JoinedCan, AHeldWireIsSeenByAllAtOnce) {
  Script script = all_there();
  script.send(4, 1'000'000 - 30'000, 0x100, 8);
  script.send(2, 1'500'000, 0x101, 8);
  script.fault(FaultKind::can_stuck_dominant, 1'020'000, 1'300'000);
  script.fault(FaultKind::can_stuck_dominant, 1'555'123, 1'700'000);
  EXPECT_GT(same(script), 2u);
}

TEST(JoinedCan, CutLateLostUnacknowledgedAndBabbledOn) {
  for (const FaultKind kind : {FaultKind::can_cut, FaultKind::can_late, FaultKind::can_lost,
                               FaultKind::can_no_ack, FaultKind::can_babble}) {
    SCOPED_TRACE(static_cast<int>(kind));
    Script script = all_there();
    const bool babble = kind == FaultKind::can_babble;
    const double value = kind == FaultKind::can_late ? 300e-6 : babble ? 0.6 : 0.0;
    script.fault(kind, 300'000, 1'500'000, value, babble ? io::kAnywhere : 1);
    for (std::size_t n = 0; n < kNodes; ++n) {
      for (int k = 0; k < 8; ++k) {
        script.send(n, 200'000 + 217'000 * k + 31 * static_cast<int>(n),
                    0x100 + 16 * k + static_cast<unsigned>(n), 3);
      }
    }
    EXPECT_GT(same(script), 20u);
  }
}

// Its frame fails, and nobody else's does.
TEST(JoinedCan, ABoardThatIsPulledOutInItsFrameSpoilsIt) {
  Script script = all_there();
  script.send(4, 100'000, 0x100, 8);
  script.go(4, 150'000);
  script.drop(4, 150'000);
  script.send(2, 140'000, 0x200, 1);
  script.come(4, 900'000);
  script.send(4, 950'000, 0x300, 1);
  EXPECT_EQ(same(script), 3u);
  const auto log = ThreeBoards(script).seen().log;
  EXPECT_NE(line_of(log, 0).find("id 256 from 2 error 1"), std::string::npos) << line_of(log, 0);
  EXPECT_NE(line_of(log, 1).find("id 512 from 1 error 0"), std::string::npos) << line_of(log, 1);
}

TEST(JoinedCan, AnotherBitRateBreaksFramesOfAll) {
  Script script;
  for (std::size_t n = 0; n < 4; ++n) script.come(n, 0);
  script.come(4, 300'000, 2000.0);
  for (int k = 0; k < 12; ++k) script.send(2, 250'000 + 200'000 * k, 0x2AA, 4);
  script.send(4, 1'000'000, 0x155, 4);
  EXPECT_GT(same(script), 10u);
}

// One that is faster sees six equal bits where there are five, as soon as in a slower one's identifier.
TEST(JoinedCan, AFasterOneBreaksAFrameEarly) {
  Script script;
  for (std::size_t n = 0; n < 4; ++n) script.come(n, 0, 1250.0);
  script.come(4, 0, 1000.0);
  for (int k = 0; k < 8; ++k) script.send(2, 250'007 + 200'011 * k, 7, 4);
  EXPECT_GT(same(script), 10u);
}

// Of bits that are no whole nanoseconds, as a crystal's are.
TEST(JoinedCan, RatesThatFitTalk) {
  Script script;
  for (std::size_t n = 0; n < kNodes; ++n)
    script.come(n, 0, 1000.0 + 0.37 * static_cast<double>(n));
  for (std::size_t n = 0; n < kNodes; ++n)
    script.send(n, 500'000, 0x12345600u + static_cast<unsigned>(n), 7);
  EXPECT_EQ(same(script), 5u);
}

// What a sender asks in the nanosecond in which something ends or begins, and at boundaries.
TEST(JoinedCan, ManyAskAtOnceAtABoundary) {
  Script script = all_there();
  for (std::size_t n = 0; n < kNodes; ++n) {
    script.send(n, kGrain_ns, 0x200 + static_cast<unsigned>(n));
    script.send(n, 2 * kGrain_ns, 0x200 - static_cast<unsigned>(n));
  }
  EXPECT_EQ(same(script), 10u);
}

Script at_random(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto draw = [&random](int below) {
    return static_cast<int>(random() % static_cast<unsigned>(below));
  };
  Script script;
  script.grains = 6;
  const int end_us = script.grains * 1000;
  for (std::size_t n = 0; n < kNodes; ++n) script.come(n, draw(400) * 1000 + draw(2) * draw(1000));
  const int sends = 20 + draw(60);
  for (int k = 0; k < sends; ++k) {
    // Some of them together: on a grid of 100 us.
    const Nanoseconds t =
        draw(3) == 0 ? draw(end_us / 100) * 100 * kBit : draw(end_us) * kBit + draw(1000);
    // The base identifiers of two nodes differ: that is what the look-ahead wants.
    const auto node = static_cast<std::size_t>(draw(kNodes));
    const auto id = static_cast<std::uint32_t>(draw(300) * static_cast<int>(kNodes)) +
                    static_cast<std::uint32_t>(node);
    script.send(node, t, draw(2) == 0 ? id : id << 14 | 0x2000, static_cast<std::uint8_t>(draw(9)));
  }
  for (int k = draw(4); k > 0; --k) {
    const auto node = static_cast<std::size_t>(draw(kNodes));
    const Nanoseconds t = draw(end_us) * kBit + draw(1000);
    script.go(node, t);
    if (draw(2) == 0) script.drop(node, t + draw(100'000));
    script.come(node, t + draw(1'000'000));
  }
  const FaultKind kinds[] = {FaultKind::can_cut,       FaultKind::can_late,
                             FaultKind::can_lost,      FaultKind::can_no_ack,
                             FaultKind::can_bit_error, FaultKind::can_stuck_dominant,
                             FaultKind::can_babble};
  for (int k = draw(4); k > 0; --k) {
    const FaultKind kind = kinds[draw(7)];
    const Nanoseconds from = draw(end_us) * kBit + draw(1000);
    const bool whole = kind == FaultKind::can_babble || kind == FaultKind::can_stuck_dominant;
    script.fault(kind, from, from + draw(1'500'000),
                 kind == FaultKind::can_late ? draw(400) * 1e-6
                 : whole                     ? 0.5
                                             : 0.0,
                 whole || draw(2) == 0 ? io::kAnywhere : draw(3));
  }
  return script;
}

TEST(JoinedCan, WhateverHappensIsToldAsOnOneBus) {
  std::size_t frames = 0;
  std::vector<std::uint32_t> seeds{1104, 1720};  // an end and a beginning in one nanosecond
  for (std::uint32_t seed = 1; seed <= 60; ++seed) seeds.push_back(seed);
  for (const std::uint32_t seed : seeds) {
    SCOPED_TRACE(seed);
    frames += same(at_random(seed));
    if (HasFailure()) return;
  }
  EXPECT_GT(frames, 1500u);
}

TEST(JoinedCan, ADeadBoardEndsTheWaitOfTheOthers) {
  Script script = all_there();
  script.send(2, 1'200'000, 0x100, 8);
  for (const std::size_t dead : {0u, 1u, 2u}) {
    ThreeBoards boards(script);
    boards.run(0, 1);
    std::thread reaper([&] {
      while (!boards.all_wait(dead)) std::this_thread::yield();
      for (std::size_t b = 1; b < 3; ++b) boards.wire(b).close();
    });
    boards.run(1, 2, static_cast<int>(dead));
    reaper.join();
    EXPECT_EQ(boards.board(0).closed, dead != 0) << dead;
    for (std::size_t b = 1; b < 3 && dead == 0; ++b) EXPECT_TRUE(boards.board(b).closed) << b;
  }
}

}  // namespace
}  // namespace whirl::board

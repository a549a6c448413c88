// The link, tested as it is used: two processes and one memory.
#include "io_bridges/link/channel.hpp"

#include <gtest/gtest.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <functional>
#include <tuple>
#include <vector>

#include "io_bridges/messages/messages.hpp"

namespace whirl::io {
namespace {

std::span<const std::uint8_t> bytes_of(const std::vector<std::uint8_t>& text) {
  return text;
}

// Runs `board` on the other end in a process of its own; returns its exit code.
int with_board(Channel& harness, const std::function<int(Channel&)>& board,
               const std::function<void()>& here) {
  const int fd = dup(harness.fd());
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    auto link = Channel::attach(Side::board, fd);
    _exit(link ? board(link.value()) : 99);
  }
  close(fd);
  here();
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// The board sleeps for a delivery while its timer interrupts it; the twentieth signal asks for one.
TEST(Channel, WhatWakesASleeperWithoutADeliveryIsNone) {
  auto link = Channel::create(Side::harness, 1 << 12);
  ASSERT_TRUE(link);
  static Channel* sleeper = nullptr;
  static volatile int signals = 0;
  const auto sleeps = [](Channel& board) {
    sleeper = &board;
    struct sigaction action {};
    action.sa_handler = [](int) {
      signals = signals + 1;
      if (signals == 20) std::ignore = sleeper->post(20, {});
    };
    sigaction(SIGALRM, &action, nullptr);
    const itimerval each_ms{{0, 1000}, {0, 1000}};
    setitimer(ITIMER_REAL, &each_ms, nullptr);
    if (!board.wait(-1)) return 1;
    return signals >= 20 && board.received().t_ns == 7 ? 0 : 2;
  };
  const int exit_code = with_board(link.value(), sleeps, [&] {
    ASSERT_TRUE(link.value().wait(50'000));
    ASSERT_TRUE(link.value().post(7, {}));
  });
  EXPECT_EQ(exit_code, 0);
}

TEST(Channel, CarriesEveryBatchOnceAndInOrderBetweenTwoProcesses) {
  auto link = Channel::create(Side::harness, 1 << 16);
  ASSERT_TRUE(link);
  Channel& harness = link.value();
  constexpr int kRounds = 2000;
  // The board answers each batch with its bytes plus one.
  const auto echo = [](Channel& board) {
    for (int k = 0; k < kRounds; ++k) {
      if (!board.wait(5000)) return 1;
      const Delivery got = board.received();
      std::vector<std::uint8_t> answer(got.bytes.begin(), got.bytes.end());
      for (std::uint8_t& byte : answer) ++byte;
      if (!board.post(got.t_ns + 1, answer)) return 2;
    }
    return 0;
  };
  const int exit_code = with_board(harness, echo, [&] {
    for (int k = 0; k < kRounds; ++k) {
      const std::vector<std::uint8_t> sent(static_cast<std::size_t>(k % 300),
                                           static_cast<std::uint8_t>(k));
      ASSERT_TRUE(harness.post(k * 1000, bytes_of(sent)));
      ASSERT_TRUE(harness.wait(5000)) << k;
      ASSERT_EQ(harness.received().t_ns, k * 1000 + 1);
      ASSERT_EQ(harness.received().bytes.size(), sent.size());
      for (const std::uint8_t byte : harness.received().bytes) {
        ASSERT_EQ(byte, static_cast<std::uint8_t>(k + 1));
      }
    }
  });
  EXPECT_EQ(exit_code, 0);
}

TEST(Channel, RefusesABatchBeyondItsLimitAndStaysUsable) {
  auto link = Channel::create(Side::harness, 64);
  ASSERT_TRUE(link);
  const std::vector<std::uint8_t> fits(64), too_long(65);
  EXPECT_TRUE(link.value().post(0, too_long).ok() == false);
  EXPECT_TRUE(link.value().post(0, fits).ok());
}

TEST(Channel, WaitEndsWhenNobodyAnswers) {
  auto link = Channel::create(Side::harness, 64);
  ASSERT_TRUE(link);
  EXPECT_FALSE(link.value().wait(1));
}

TEST(Channel, AFailureOfTheBoardArrivesInItsOwnWords) {
  auto link = Channel::create(Side::harness, 64);
  ASSERT_TRUE(link);
  with_board(
      link.value(),
      [](Channel& board) {
        board.fail({ErrorKind::bad_input, "flight.elf", "not an ELF file", "build it"});
        return 0;
      },
      [&] { ASSERT_TRUE(link.value().wait(5000)); });
  ASSERT_EQ(link.value().state(), BoardState::failed);
  EXPECT_EQ(link.value().failure().message(), "flight.elf: not an ELF file (build it)");
  EXPECT_EQ(link.value().failure().kind, ErrorKind::bad_input);
}

TEST(Channel, AForeignDescriptorIsNoLink) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  EXPECT_FALSE(Channel::attach(Side::board, ends[0]).ok());
  close(ends[0]);
  close(ends[1]);
}

TEST(Reader, ABatchThatWasCutOffIsNoticed) {
  Batch batch;
  batch.add(Kind::body_motion, 0, 5, BodyMotion{});
  Reader whole(batch.bytes());
  EXPECT_TRUE(whole.next());
  EXPECT_TRUE(whole.complete());
  Reader cut(batch.bytes().first(batch.bytes().size() - 1));
  EXPECT_FALSE(cut.next());
  EXPECT_FALSE(cut.complete());
}

}  // namespace
}  // namespace whirl::io

// The wire, tested as it is used: two processes and one page.
#include "io_bridges/link/wire.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

namespace whirl::io {
namespace {

// Runs `follower` in a process of its own; returns its exit code.
int with_follower(BoardWire& leader, const std::function<int(BoardWire&)>& follower,
                  const std::function<void()>& here) {
  const int fd = dup(leader.fd());
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    auto wire = BoardWire::attach(fd);
    _exit(wire ? follower(wire.value()) : 99);
  }
  close(fd);
  here();
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// boards: 1 spins long where there are two cores, 99 goes to sleep.
class Wires : public ::testing::TestWithParam<int> {
 protected:
  Wires() : made_(BoardWire::create(GetParam())) {}
  BoardWire& wire() { return made_.value(); }

 private:
  Result<BoardWire> made_;
};
INSTANTIATE_TEST_SUITE_P(Wires, Wires, ::testing::Values(1, 99));

// Questions, each behind some that want no answer.
TEST_P(Wires, EveryQuestionGetsItsAnswerInOrder) {
  constexpr int kQuestions = 2000;
  const auto follows = [](BoardWire& other) {
    std::int64_t last_ns = -1;
    for (int asked = 0; asked < kQuestions;) {
      const WireMessage* message = other.front();
      if (message == nullptr || message->t_ns <= last_ns) return 1;
      const WireMessage taken = *message;
      last_ns = taken.t_ns;
      other.pop();
      if (taken.act != WireAct::write) continue;
      if (taken.byte != asked % 256) return 2;
      other.answer({.t_ns = taken.t_ns + 5, .byte = static_cast<std::uint8_t>(~taken.byte)});
      ++asked;
    }
    return 0;
  };
  const int exit_code = with_follower(wire(), follows, [this] {
    std::int64_t t_ns = 0;
    for (int k = 0; k < kQuestions; ++k) {
      for (int i = 0; i < k % 4; ++i) ASSERT_TRUE(wire().post({++t_ns, WireAct::stop}));
      const auto byte = static_cast<std::uint8_t>(k);
      const auto answer = wire().ask({++t_ns, WireAct::write, byte});
      ASSERT_TRUE(answer);
      ASSERT_EQ(answer->t_ns, t_ns + 5);
      ASSERT_EQ(answer->byte, static_cast<std::uint8_t>(~byte));
    }
  });
  EXPECT_EQ(exit_code, 0);
}

// Far more than the ring holds, and the follower begins late.
TEST_P(Wires, AFullRingMakesTheLeaderWaitAndLosesNothing) {
  constexpr int kMessages = 2000;
  const auto follows = [](BoardWire& other) {
    for (int k = 0; k < kMessages; ++k) {
      const WireMessage* message = other.front();
      if (message == nullptr || message->t_ns != k) return 1;
      other.pop();
    }
    return 0;
  };
  const int exit_code = with_follower(wire(), follows, [this] {
    for (int k = 0; k < kMessages; ++k) ASSERT_TRUE(wire().post({k, WireAct::start}));
  });
  EXPECT_EQ(exit_code, 0);
}

TEST_P(Wires, ClosingWakesWhoWaitsForAMessageAndWhoWaitsForAnAnswer) {
  const auto until_it_waits = [this](bool (BoardWire::*waits)() const) {
    while (!(wire().*waits)()) usleep(100);
  };
  const auto no_message = [](BoardWire& other) { return other.front() == nullptr ? 0 : 1; };
  EXPECT_EQ(with_follower(wire(), no_message,
                          [&] {
                            until_it_waits(&BoardWire::follower_waits);
                            wire().close();
                          }),
            0);
  auto second = BoardWire::create(GetParam());
  const auto closes = [](BoardWire& other) {
    while (!other.leader_waits()) usleep(100);
    other.close();
    return 0;
  };
  EXPECT_EQ(with_follower(second.value(), closes,
                          [&] {
                            EXPECT_FALSE(second.value().ask({1, WireAct::fetch}));
                          }),
            0);
  EXPECT_FALSE(second.value().post({2, WireAct::stop}));
}

TEST(Wire, WhatIsNoWireIsRefused) {
  EXPECT_FALSE(BoardWire::attach(-1));
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const auto wire = BoardWire::attach(ends[0]);
  ASSERT_FALSE(wire);
  EXPECT_EQ(wire.error().kind, ErrorKind::internal);
  close(ends[0]);
  close(ends[1]);
}

}  // namespace
}  // namespace whirl::io

// Five real images that wait for each other: one that is killed, at any moment, ends the run by its name.
//
//   Moments  drawn from a seed, in host time since the board's process is there: while others are still being
//            started, while the images boot, in flight
//   Kills    3 of each, or $WHIRL_KILLS: twenty take a minute
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "base/scratch_folder.hpp"

namespace whirl {
namespace {

constexpr const char* kBoards[] = {"flight", "esc1", "esc2", "esc3", "esc4"};
constexpr int kInconclusive = 3;
constexpr int kStart_ms = 30'000, kEnd_ms = 5'000, kTick_us = 5'000;

std::vector<pid_t> children_of(pid_t pid) {
  const std::string id = std::to_string(pid);
  std::ifstream list("/proc/" + id + "/task/" + id + "/children");
  return {std::istream_iterator<pid_t>(list), {}};
}

// What joins the five: the plan that flies so.
struct Chain {
  const char *file, *plan;
};
constexpr Chain kOn_i2c{"hover.lua", "chain hover"}, kOn_can{"hover_can.lua", "chain hover on CAN"};

pid_t start_chain(const Chain& chain, const std::string& output) {
  const std::string line = std::string("exec ") + WHIRL_PROGRAM + " run " + WHIRL_ROOT +
                           "/test_plans/chain/" + chain.file + " --only '" + chain.plan + "' >" +
                           output + " 2>&1";
  const pid_t pid = fork();
  if (pid == 0) {
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  return pid;
}

// The process of that board, in the order in which they are started; 0: none came.
pid_t board_of(pid_t program, std::size_t number) {
  for (int waited_ms = 0; waited_ms < kStart_ms; waited_ms += kTick_us / 1000) {
    const std::vector<pid_t> boards = children_of(program);
    if (boards.size() > number) return boards[number];
    usleep(kTick_us);
  }
  return 0;
}

// Its wait status; -1: it was still there at the end of the time.
int status_within(pid_t program, int most_ms) {
  int status = 0;
  for (int waited_ms = 0; waited_ms < most_ms; waited_ms += kTick_us / 1000) {
    if (waitpid(program, &status, WNOHANG) == program) return status;
    usleep(kTick_us);
  }
  kill(program, SIGKILL);
  waitpid(program, &status, 0);
  return -1;
}

int lines_with(const std::string& text, const std::string& words) {
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find(words) != std::string::npos) ++count;
  }
  return count;
}

// What outlives its parent becomes a child of this process.
std::vector<pid_t> orphans() {
  while (waitpid(-1, nullptr, WNOHANG) > 0) {
  }
  return children_of(getpid());
}

void kill_and_judge(const Chain& chain, std::size_t board, int moment_ms,
                    const std::string& output) {
  const pid_t program = start_chain(chain, output);
  const pid_t victim = board_of(program, board);
  ASSERT_NE(victim, 0) << "did not start";
  usleep(static_cast<useconds_t>(moment_ms) * 1000);
  ASSERT_EQ(kill(victim, SIGKILL), 0);
  const int status = status_within(program, kEnd_ms);
  ASSERT_NE(status, -1) << "still runs after 5 s";
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == kInconclusive) << status;
  std::ifstream in(output);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const std::string name = kBoards[board];
  EXPECT_EQ(lines_with(text, name + ": virtual board: QEMU was ended by signal Killed"), 1) << text;
  EXPECT_EQ(lines_with(text, "virtual board:"), 1) << text;  // and of no other
  EXPECT_TRUE(orphans().empty());
}

void kill_boards(const Chain& chain) {
  const ScratchFolder folder;
  setenv("WHIRL_RESULTS", folder.file("results").c_str(), 1);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const char* wanted = std::getenv("WHIRL_KILLS");
  const int kills = wanted == nullptr ? 3 : std::atoi(wanted);
  ASSERT_GT(kills, 0) << "WHIRL_KILLS";
  std::mt19937 random(1);
  for (int k = 0; k < kills; ++k) {
    const auto board = static_cast<std::size_t>(3 * k % 5);
    const int moment_ms = static_cast<int>(random() % (kills > 3 ? 4000 : 1000));
    SCOPED_TRACE(std::string(kBoards[board]) + " after " + std::to_string(moment_ms) + " ms");
    kill_and_judge(chain, board, moment_ms, folder.file("told"));
    if (kills > 3) printf("%s after %d ms\n", kBoards[board], moment_ms);
    std::system(("rm -rf " + folder.file("results")).c_str());
  }
}

TEST(Chain, ABoardThatIsKilledAtAnyMomentEndsARunOfFiveByItsNameWithinFiveSeconds) {
  kill_boards(kOn_i2c);
}

TEST(Chain, SoItDoesOnCan) {
  kill_boards(kOn_can);
}

}  // namespace
}  // namespace whirl

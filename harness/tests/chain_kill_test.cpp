// Five real images that wait for each other: one that is killed ends the run by its name.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "base/scratch_folder.hpp"

namespace whirl {
namespace {

std::vector<pid_t> children_of(pid_t pid) {
  const std::string id = std::to_string(pid);
  std::ifstream list("/proc/" + id + "/task/" + id + "/children");
  return {std::istream_iterator<pid_t>(list), {}};
}

// Five boards that wait for each other; the leader, or one of those that follow it, is killed in flight.
TEST(Chain, ABoardThatIsKilledEndsARunOfFiveByItsNameWithinFiveSeconds) {
  const ScratchFolder folder;
  setenv("WHIRL_RESULTS", folder.file("results").c_str(), 1);
  const std::pair<std::size_t, const char*> kBoards[] = {{0, "flight: virtual board"},
                                                         {3, "esc3: virtual board"}};
  for (const auto& [number, name] : kBoards) {
    const std::string told = folder.file("told");
    const std::string line = std::string("exec ") + WHIRL_PROGRAM + " run " + WHIRL_ROOT +
                             "/test_plans/chain/hover.lua >" + told + " 2>&1";
    const pid_t pid = fork();
    if (pid == 0) {
      execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      _exit(127);
    }
    std::vector<pid_t> boards;
    for (int tries = 0; tries < 3000 && boards.size() < 5; ++tries) {
      usleep(10'000);
      boards = children_of(pid);
    }
    ASSERT_GE(boards.size(), 5U) << "the boards did not start within 30 s";
    usleep(300'000 * static_cast<useconds_t>(number + 1));
    kill(boards[number], SIGKILL);
    int status = 0, waited = 0;
    while (waitpid(pid, &status, WNOHANG) == 0 && waited < 500) usleep(10'000), ++waited;
    if (waited == 500) kill(pid, SIGKILL), waitpid(pid, &status, 0);
    EXPECT_LT(waited, 500) << name;
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 3) << status;
    std::ifstream in(told);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    EXPECT_NE(text.find(std::string(name) + ": QEMU was ended by signal Killed"), std::string::npos)
        << text;
    for (const pid_t board : boards) EXPECT_EQ(kill(board, 0), -1) << name << " left " << board;
  }
}

}  // namespace
}  // namespace whirl

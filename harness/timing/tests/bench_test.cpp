// Both timing images in the real QEMU: every kernel of the tables reports, whatever it cost. Whether the
// virtual board's clock meets the tables is for whirl validate --timing to say.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "base/scratch_folder.hpp"

namespace whirl {
namespace {

struct Outcome {
  int code = -1;
  std::string text;
};

Outcome validate(const std::string& arguments) {
  const std::string line = std::string(WHIRL_PROGRAM) + " validate --timing " + arguments + " 2>&1";
  std::FILE* pipe = popen(line.c_str(), "r");
  Outcome outcome;
  char piece[4096];
  for (std::size_t n; (n = std::fread(piece, 1, sizeof piece, pipe)) > 0;) {
    outcome.text.append(piece, n);
  }
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

TEST(TimingBench, EveryKernelReportsAndTheKeptLinesAreJudgedAlike) {
  const ScratchFolder folder;
  setenv("WHIRL_RESULTS", folder.path().c_str(), 1);
  const Outcome bench = validate("");
  EXPECT_TRUE(bench.code == 0 || bench.code == 1) << bench.code << bench.text;
  for (const char* trouble : {"NOT REPORTED", "NOT IN THE TABLE", "cut short"}) {
    EXPECT_EQ(bench.text.find(trouble), std::string::npos) << trouble << "\n" << bench.text;
  }
  for (const char* part : {"f405", "f103"}) {
    EXPECT_NE(bench.text.find(std::string("\nstm32") + part + ": "), std::string::npos) << part;
    const std::string kept = folder.file(std::string("validation/timing_") + part + ".txt");
    const Outcome again = validate(kept);
    const std::size_t score = again.text.find("\nstm32");
    ASSERT_NE(score, std::string::npos) << again.text;
    const std::string line = again.text.substr(score, again.text.find('\n', score + 1) - score);
    EXPECT_NE(bench.text.find(line), std::string::npos) << line;
  }
  EXPECT_TRUE(std::filesystem::exists(folder.file("validation/timing.html")));
}

}  // namespace
}  // namespace whirl

// `whirl bench check` as a user meets it: a line for each thing that is missing, what cannot be known, and exit code 2.
#include <gtest/gtest.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <thread>

#include "base/output_file.hpp"
#include "base/scratch_folder.hpp"
#include "io_bridges/serial/pseudo_terminal.hpp"
#include "io_bridges/serial/tty.hpp"

namespace whirl::cli {
namespace {

// From now on this process gets no socket of CAN, and that reason.
void refuse_can(int reason) {
  constexpr auto kNumber = static_cast<std::uint32_t>(offsetof(seccomp_data, nr));
  constexpr auto kFamily = static_cast<std::uint32_t>(offsetof(seccomp_data, args));
  sock_filter code[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kNumber),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_socket, 0, 3),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kFamily),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AF_CAN, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | static_cast<unsigned>(reason)),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
  sock_fprog program{static_cast<unsigned short>(std::size(code)), code};
  const bool refused = prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
                       prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
  if (!refused) _exit(100);
}

void be_nobody() {
  constexpr unsigned kNobody = 65534;
  if (geteuid() == 0 && (setgid(kNobody) != 0 || setuid(kNobody) != 0)) _exit(101);
}

struct Checked {
  int code = -1;
  std::string text;
  bool says(const std::string& words) const { return text.find(words) != std::string::npos; }
};

class BenchCheck : public testing::Test {
 protected:
  BenchCheck() { std::filesystem::permissions(folder_.path(), std::filesystem::perms(0755)); }

  // in_child: what it does before it becomes the program.
  Checked check(
      const std::string& board, const std::string& keys,
      const std::function<void()>& in_child = [] {}) const {
    const std::string file = folder_.file("b.lua");
    EXPECT_TRUE(write_text(file, "return { bench = \"b\", board = \"" + board + "\", " + keys +
                                     ", safety = { phrase = \"clear\", longest = \"60 s\" } }"));
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      dup2(ends[1], STDOUT_FILENO);
      dup2(ends[1], STDERR_FILENO);
      close(ends[0]);
      close(ends[1]);
      in_child();
      execl(WHIRL_PROGRAM, WHIRL_PROGRAM, "bench", "check", file.c_str(), "--seconds", "0.3",
            static_cast<char*>(nullptr));
      _exit(102);
    }
    close(ends[1]);
    Checked checked;
    char piece[4096];
    for (ssize_t n; (n = read(ends[0], piece, sizeof piece)) > 0;) {
      checked.text.append(piece, static_cast<std::size_t>(n));
    }
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    checked.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return checked;
  }

  ScratchFolder folder_;
};

// One line each; what is wrong ends with what helps.
void expect_missing(const Checked& checked, const std::string& name, const std::string& words) {
  EXPECT_EQ(checked.code, 2) << checked.text;
  const auto at = checked.text.find("MISSING: ");
  ASSERT_NE(at, std::string::npos) << checked.text;
  const auto begin = checked.text.rfind('\n', at) + 1, end = checked.text.find('\n', at);
  const std::string line = checked.text.substr(begin, end - begin);
  EXPECT_EQ(line.rfind("  " + name + " ", 0), 0u) << line;
  EXPECT_NE(line.find(words), std::string::npos) << line;
  EXPECT_EQ(checked.text.find("MISSING: ", at + 1), std::string::npos) << checked.text;
}

const std::string kOnCan =
    R"(links = { { name = "bus", bus = "can1", interface = "whirl_none" } }, instruments = {})";

TEST_F(BenchCheck, CanThatThisKernelHasNotOrRefuses) {
  const auto refused = [&](int reason) {
    return check("esc32v2_can", kOnCan, [reason] { refuse_can(reason); });
  };
  expect_missing(refused(EAFNOSUPPORT), "bus", "this kernel has no CAN (AF_CAN)");
  expect_missing(refused(EPERM), "bus", "no permission for CAN sockets");
}

// Only a kernel with CAN tells it: not tested.
TEST_F(BenchCheck, AnInterfaceThatIsNotThere) {
  const int can = socket(AF_CAN, SOCK_RAW, 1);
  const bool knows_can = can >= 0;
  if (knows_can) close(can);
  const Checked checked = check("esc32v2_can", kOnCan);
  expect_missing(checked, "bus", knows_can ? "no such CAN interface" : "AF_CAN");
}

std::string terminal_at(const std::string& path) {
  return R"(links = { { name = "terminal", bus = "usart1", path = ")" + path +
         R"(" } }, instruments = {})";
}

TEST_F(BenchCheck, ASerialLineThatIsNotThereOrIsNone) {
  expect_missing(check("esc32v2", terminal_at(folder_.file("no_tty"))), "terminal",
                 "no_tty: no such serial line");
  expect_missing(check("esc32v2", terminal_at("/dev/null")), "terminal",
                 "/dev/null: is no serial line");
}

TEST_F(BenchCheck, ASerialLineThatOneMayNotUseOrAnotherHolds) {
  const io::PseudoTerminal far = std::move(io::PseudoTerminal::open().value());
  ASSERT_EQ(chmod(far.path().c_str(), 0600), 0);
  if (geteuid() != 0) {
    ASSERT_EQ(chmod(far.path().c_str(), 0), 0);
  }
  expect_missing(check("esc32v2", terminal_at(far.path()), be_nobody), "terminal",
                 far.path() + ": no permission");
  ASSERT_EQ(chmod(far.path().c_str(), 0600), 0);
  const auto held = io::Tty::open(far.path(), 115200);
  ASSERT_TRUE(held.ok());
  expect_missing(check("esc32v2", terminal_at(far.path())), "terminal",
                 far.path() + ": another program holds it");
}

TEST_F(BenchCheck, WhoSaysNothingIsMissing) {
  const io::PseudoTerminal far = std::move(io::PseudoTerminal::open().value());
  expect_missing(check("esc32v2", terminal_at(far.path())), "terminal",
                 "says nothing, and does not answer \"status\"");
  expect_missing(check("esc32v2", R"(links = {}, instruments = { { name = "cell", path = ")" +
                                      far.path() + R"(", readings = { { signal = "thrust", column =
                                      1, scale = "1 N" } } } })"),
                 "cell", "says nothing");
  const Checked pod =
      check("px4fmu_v1_sbus", R"(links = { { name = "pod", pod = "pod_with_receivers", path = ")" +
                                  far.path() + R"(" } }, instruments = {})");
  expect_missing(pod, "pod", "says nothing in a second");
  expect_missing(check("px4fmu_v1_sbus", R"(links = { { name = "pod", pod =
                       "pod_with_receivers_can", interface = "whirl_none" } }, instruments = {})",
                       [] { refuse_can(EAFNOSUPPORT); }),
                 "pod", "this kernel has no CAN (AF_CAN)");
}

TEST_F(BenchCheck, ABridgeAnAnalyserAndAProbeThatAreNotThere) {
  expect_missing(check("esc32v2", R"(links = { { name = "throttle", bus = "i2c2", bridge = "cp2112",
                       serial = "whirl has no such one" } }, instruments = {})"),
                 "throttle", "CP2112");
  const std::string none = "links = {}, instruments = {}, ";
  expect_missing(check("esc32v2", none + R"(probe = { interface = "interface/none.cfg",
                       target = "target/stm32f1x.cfg" })"),
                 "probe", "interface/none.cfg");
  const Checked clips = check("esc32v2", none + R"(analyser = { driver = "whirl_none", rate =
    "24 MHz", marker = "/dev/null", channels = { D0 = "i2c2_scl", D7 = "marker" } })");
  EXPECT_EQ(clips.code, 2) << clips.text;
  EXPECT_TRUE(clips.says("  analyser     MISSING: ")) << clips.text;
  EXPECT_TRUE(clips.says("  marker       MISSING: /dev/null: ")) << clips.text;
}

// An ESC's command line at the far end, in a thread of its own.
TEST_F(BenchCheck, WhatAnswersIsTimedAndNothingIsMissing) {
  io::PseudoTerminal far = std::move(io::PseudoTerminal::open().value());
  std::atomic<bool> ending = false;
  std::thread esc([&] {
    std::array<std::uint8_t, 64> bytes;
    const std::string_view answer = "status 0 0 0\r\n";
    while (!ending) {
      if (far.read(bytes) > 0) {
        far.write({reinterpret_cast<const std::uint8_t*>(answer.data()), answer.size()});
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  const Checked checked = check("esc32v2", terminal_at(far.path()));
  ending = true;
  esc.join();
  EXPECT_EQ(checked.code, 0) << checked.text;
  EXPECT_TRUE(checked.says("\"status\" answered 20 of 20 times; to its first byte p50 "))
      << checked.text;
  EXPECT_TRUE(checked.says("a command line of firmware that is not ours")) << checked.text;
  for (const char* others : {"SBUS", "hardware time stamps", "marker", "a pod", "debug probe"}) {
    EXPECT_FALSE(checked.says(others)) << others << "\n" << checked.text;
  }
}

TEST_F(BenchCheck, WhatCannotBeKnownIsSaidAndIsNotMissing) {
  const io::PseudoTerminal sticks = std::move(io::PseudoTerminal::open().value());
  const io::PseudoTerminal gps = std::move(io::PseudoTerminal::open().value());
  const Checked checked = check(
      "px4fmu_v1_sbus", R"(links = { { name = "sticks", bus = "usart1", path = ")" + sticks.path() +
                            R"(" }, { name = "gps", bus = "usart6", path = ")" + gps.path() +
                            R"(" } }, instruments = {})");
  EXPECT_EQ(checked.code, 0) << checked.text;
  EXPECT_TRUE(checked.says(" at 100000 baud 8E2, SBUS: nothing comes")) << checked.text;
  EXPECT_TRUE(checked.says("8N1, as the GPS starts: nothing comes; ")) << checked.text;
  EXPECT_TRUE(checked.says("cannot be known before a run")) << checked.text;
  EXPECT_TRUE(checked.says("SBUS by an adapter at 100000 baud 8E2, and its inverter"));
  EXPECT_TRUE(checked.says("a GPS's line while its rate changes"));
}

// The files that the guide's first hours begin with: each is read, its links are visited, and its plan asks for nothing but the word.
TEST(Benches, EachOfTheGuidesIsReadAndFitsItsPlan) {
  const auto said = [](const std::string& words) {
    std::FILE* pipe = popen((std::string(WHIRL_PROGRAM) + " " + words + " 2>&1").c_str(), "r");
    std::string text;
    char piece[4096];
    for (std::size_t n; (n = std::fread(piece, 1, sizeof piece, pipe)) > 0;) text.append(piece, n);
    const int status = pclose(pipe);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 2) << text;  // nothing is there
    return text;
  };
  const std::map<std::string, std::string> plans{{"esc_stand", "bench/rise.lua"},
                                                 {"esc_on_can", "bench/rise_can.lua"},
                                                 {"flight_on_can", "flight/bench_hover.lua"},
                                                 {"flight_with_pod", "flight/bench_hover_pod.lua"}};
  const std::string root = WHIRL_ROOT;
  std::size_t files = 0;
  for (const auto& file : std::filesystem::directory_iterator(root + "/test_plans/benches")) {
    const std::string name = file.path().stem();
    ++files;
    const auto plan = plans.find(name);
    ASSERT_NE(plan, plans.end()) << name << ": which plan is it for?";
    const std::string checked = said("bench check " + name + " --seconds 0.1");
    EXPECT_NE(checked.find(name + ".lua: " + name + " on "), std::string::npos) << checked;
    EXPECT_NE(checked.find("MISSING: "), std::string::npos) << checked;
    EXPECT_NE(checked.find("nobody has proven without hardware"), std::string::npos) << checked;
    const ScratchFolder out;
    const std::string refused = said("run " + root + "/test_plans/" + plan->second +
                                     " --target bench/" + name + " --out " + out.path());
    EXPECT_NE(refused.find("nobody has said that all is clear"), std::string::npos) << refused;
  }
  EXPECT_EQ(files, plans.size());
}

}  // namespace
}  // namespace whirl::cli

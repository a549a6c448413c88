// Whatever ends or stops QEMU: a verdict, no stuck command, no process left.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

TEST(Failure, LockUpIsNamedWithTheHandlerThatFaulted) {
  const BoardRun run = run_for({image("lockup"), {}}, 2);
  EXPECT_EQ(run.error.what, "");
  EXPECT_EQ(run.state, TargetState::cpu_locked);
  const auto faults = run.of(io::Kind::cpu_fault);
  ASSERT_EQ(faults.size(), 2u);  // the HardFault, and the lock-up in its handler
  EXPECT_EQ(faults[0]->as<io::CpuFault>().exception, 3u);
  EXPECT_EQ(faults[1]->as<io::CpuFault>().exception, 255u);
  const std::string where = run.text_of(*faults[1], sizeof(io::CpuFault));
  EXPECT_EQ(where.find("hard_fault_handler"), 0u) << where;
}

// A bug of ours is no fault of the firmware: an internal error, in words.
TEST(Failure, OurOwnBugsAreInternalErrorsInWords) {
  const std::pair<const char*, const char*> kBugs[] = {
      {"bug1", "check failed: how != 1  with how = 1"},
      {"bug3", "QEMU aborted"},
      {"bug4", "thrown on purpose"},
      {"bug5", "check failed: at_this_instant_"}};
  for (const auto& [name, words] : kBugs) {
    const BoardRun run = run_for({image(name), {}}, 2);
    EXPECT_EQ(run.error.kind, ErrorKind::internal) << name;
    EXPECT_NE(run.error.what.find(words), std::string::npos) << name << ": " << run.error.what;
    EXPECT_TRUE(run.of(io::Kind::cpu_fault).empty()) << name;
  }
}

TEST(Failure, WantOfMemoryIsTheHosts) {
  const BoardRun run = run_for({image("bug2"), {}}, 2);
  EXPECT_EQ(run.error.kind, ErrorKind::host);
  EXPECT_NE(run.error.what.find("out of memory"), std::string::npos) << run.error.what;
}

TEST(Failure, AStackAmongRegistersIsAFirmwareFaultByName) {
  for (const char* name : {"lost_stack1", "lost_stack2", "lost_stack3", "lost_stack4"}) {
    const BoardRun run = run_for({image(name), {}}, 2);
    EXPECT_EQ(run.error.what, "") << name;
    EXPECT_EQ(run.state, TargetState::cpu_locked) << name;
    const auto faults = run.of(io::Kind::cpu_fault);
    ASSERT_FALSE(faults.empty()) << name;
    EXPECT_EQ(faults.back()->as<io::CpuFault>().exception, 254u) << name;
  }
}

TEST(Failure, CodeInMemoryThatThePartCannotFetchFromIsSaidOnce) {
  const BoardRun run = run_for({image("ccm_code"), {}}, 2);
  EXPECT_EQ(run.said(), (std::vector<std::uint32_t>{7, 7, 7}));
  int told = 0;
  for (const Message* finding : run.of(io::Kind::finding)) {
    told += run.text_of(*finding).find("fetched from CCM at 0x10000100") != std::string::npos;
  }
  EXPECT_EQ(told, 1);
  EXPECT_FALSE(run_for({image("idle"), {}}, 2).found("CCM"));
}

TEST(Failure, ASleepThatIsNotModelledIsSaidOnce) {
  const BoardRun run = run_for({image("deep_sleep"), {}}, 2);
  EXPECT_EQ(run.said(), (std::vector<std::uint32_t>{4, 2}));  // SCR keeps what is there to keep
  int deep = 0, on_exit = 0;
  for (const Message* finding : run.of(io::Kind::finding)) {
    deep += run.text_of(*finding).find("WFI with SLEEPDEEP") != std::string::npos ? 1 : 0;
    on_exit += run.text_of(*finding).find("SLEEPONEXIT is set") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(deep, 1);
  EXPECT_EQ(on_exit, 1);
  const BoardRun light = run_for({image("sleeper"), {}}, 2);
  EXPECT_FALSE(light.found("SLEEPDEEP") || light.found("SLEEPONEXIT"));
}

TEST(Failure, VectorsAmongRegistersEndInALockUp) {
  const BoardRun run = run_for({image("lost_stack5"), {}}, 2);
  EXPECT_EQ(run.error.what, "");
  EXPECT_EQ(run.state, TargetState::cpu_locked);
  EXPECT_FALSE(run.of(io::Kind::cpu_fault).empty());
}

// What the target answers once a signal has come to QEMU.
Error after(int signal, int silence_s = 30) {
  BoardSetup setup{image("idle"), {}};
  setup.silence_s = silence_s;
  VirtualBoard target(options_for(setup));
  if (!target.start()) return {};
  kill(target.pid(), signal);
  if (signal == SIGSTOP) waitpid(target.pid(), nullptr, WUNTRACED);  // it stands still now
  io::Batch happened;
  for (int ms = 1; ms <= 2000; ++ms) {  // the signal arrives when the host delivers it
    target.run(ms * std::int64_t{1'000'000}, {});
    const auto state = target.arrive(happened);
    if (!state) return state.error();
    usleep(1000);
  }
  return {};
}

TEST(Failure, AnEndFromOutsideIsTheHostsAtOnce) {
  const std::pair<int, const char*> kSignals[] = {
      {SIGKILL, "ended by signal Killed"},
      {SIGABRT, "aborted QEMU"},
      {SIGXCPU, "ended by signal CPU time limit exceeded"}};
  for (const auto& [signal, words] : kSignals) {
    const Error error = after(signal);
    EXPECT_EQ(error.kind, ErrorKind::host) << words;
    EXPECT_NE(error.what.find(words), std::string::npos) << error.message();
  }
}

TEST(Failure, ACrashOfQemuIsInternal) {
  const Error error = after(SIGSEGV);
  EXPECT_EQ(error.kind, ErrorKind::internal);
  EXPECT_NE(error.what.find("Segmentation fault"), std::string::npos) << error.message();
}

TEST(Failure, AStoppedQemuIsTheHostsAfterTheSilenceLimit) {
  const Error error = after(SIGSTOP, 4);
  EXPECT_EQ(error.kind, ErrorKind::host);
  EXPECT_NE(error.what.find("stopped by a signal"), std::string::npos) << error.message();
}

TEST(Failure, AGdbPortInUseIsTheUsers) {
  const int taken = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(taken, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(taken, 1), 0);
  ASSERT_EQ(getsockname(taken, reinterpret_cast<sockaddr*>(&address), &size), 0);
  BoardSetup setup{image("idle"), {}};
  setup.gdb_port = ntohs(address.sin_port);
  VirtualBoard target(options_for(setup));
  Error error;
  io::Batch happened;
  if (const auto started = target.start(); !started) {
    error = started.error();
  } else {
    target.run(1'000'000, {});
    const auto arrived = target.arrive(happened);
    if (!arrived) error = arrived.error();
  }
  close(taken);
  EXPECT_EQ(error.kind, ErrorKind::bad_input) << error.message();
  EXPECT_EQ(error.place, "--gdb");
}

TEST(Failure, AHungQemuIsAnErrorAfterTheSilenceLimit) {
  BoardSetup setup{image("idle"), {}};
  setup.silence_s = 4;
  VirtualBoard target(options_for(setup));
  ASSERT_TRUE(target.start());
  kill(target.pid(), SIGSTOP);
  waitpid(target.pid(), nullptr, WUNTRACED);  // it stands still now
  io::Batch happened;
  target.run(1'000'000, {});
  const auto state = target.arrive(happened);
  ASSERT_FALSE(state);
  EXPECT_NE(state.error().what.find("no answer for 4 s"), std::string::npos);
  EXPECT_EQ(state.error().kind, ErrorKind::host);
  EXPECT_EQ(target.pid(), 0);
}

TEST(Failure, AMissingQemuIsNamed) {
  VirtualBoardOptions options = options_for({image("idle"), {}});
  options.qemu = "qemu-system-nowhere";
  VirtualBoard target(options);
  const auto started = target.start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().kind, ErrorKind::host);
  EXPECT_NE(started.error().what.find("qemu-system-nowhere"), std::string::npos)
      << started.error().message();
  EXPECT_FALSE(probe_qemu("qemu-system-nowhere"));
  EXPECT_TRUE(probe_qemu());
}

TEST(Failure, NoQemuOutlivesItsTarget) {
  int pid = 0;
  {
    VirtualBoard target(options_for({image("idle"), {}}));
    ASSERT_TRUE(target.start());
    pid = target.pid();
    EXPECT_EQ(kill(pid, 0), 0);
  }
  EXPECT_NE(kill(pid, 0), 0);
}

TEST(Failure, UnknownMcuAndDeviceAreBadInput) {
  VirtualBoardOptions options = options_for({image("idle"), {}});
  const BoardStart good = options.board;
  options.board.board.mcu = "stm32h743";
  EXPECT_EQ(VirtualBoard(options).start().error().kind, ErrorKind::bad_input);
  options.board = good;
  options.board.board.devices.push_back({.name = "x", .type = "toaster"});
  VirtualBoard target(options);
  const auto started = target.start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().kind, ErrorKind::bad_input);
  EXPECT_NE(started.error().message().find("bench: x: unknown type 'toaster'"), std::string::npos)
      << started.error().message();
}

}  // namespace
}  // namespace whirl::board_test

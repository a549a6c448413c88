// Whatever ends or stops QEMU: a verdict, no stuck command, no process left.
#include <gtest/gtest.h>
#include <signal.h>
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

TEST(Failure, AKilledQemuIsAnErrorAtOnce) {
  VirtualBoard target(options_for({image("idle"), {}}));
  ASSERT_TRUE(target.start());
  kill(target.pid(), SIGKILL);
  io::Batch happened;
  target.run(1'000'000, {});
  const auto state = target.arrive(happened);
  ASSERT_FALSE(state);
  EXPECT_NE(state.error().what.find("ended by signal Killed"), std::string::npos)
      << state.error().message();
}

TEST(Failure, AHungQemuIsAnErrorAfterTheSilenceLimit) {
  BoardSetup setup{image("idle"), {}};
  setup.silence_s = 1;
  VirtualBoard target(options_for(setup));
  ASSERT_TRUE(target.start());
  kill(target.pid(), SIGSTOP);
  waitpid(target.pid(), nullptr, WUNTRACED);  // it stands still now
  io::Batch happened;
  target.run(1'000'000, {});
  const auto state = target.arrive(happened);
  ASSERT_FALSE(state);
  EXPECT_NE(state.error().what.find("no answer for 1 s"), std::string::npos);
  EXPECT_EQ(target.pid(), 0);
}

TEST(Failure, AMissingQemuIsNamed) {
  VirtualBoardOptions options = options_for({image("idle"), {}});
  options.qemu = "qemu-system-nowhere";
  VirtualBoard target(options);
  const auto started = target.start();
  ASSERT_FALSE(started);
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
  const std::string good = options.board_json;
  options.board_json.replace(good.find("bench_m4"), 8, "stm32h743");
  EXPECT_EQ(VirtualBoard(options).start().error().kind, ErrorKind::bad_input);
  options.board_json = good;
  options.board_json.pop_back();
  options.board_json += R"(,"devices":[{"name":"x","type":"toaster"}]})";
  VirtualBoard target(options);
  const auto started = target.start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().kind, ErrorKind::bad_input);
  EXPECT_NE(started.error().message().find("bench: x: unknown type 'toaster'"), std::string::npos)
      << started.error().message();
}

}  // namespace
}  // namespace whirl::board_test

// gdb on the running image: stops, steps, sees functions; the world's time waits for it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <thread>

#include "base/near.hpp"
#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

std::string gdb(int port, const std::string& name, const std::string& commands) {
  const std::string line =
      "gdb-multiarch -nx -batch -ex 'set pagination off' -ex 'target remote 127.0.0.1:" +
      std::to_string(port) + "' " + commands + " " + image(name) + " 2>&1";
  FILE* pipe = popen(line.c_str(), "r");
  std::string text;
  char chunk[512];
  while (pipe != nullptr && fgets(chunk, sizeof chunk, pipe) != nullptr) text += chunk;
  if (pipe != nullptr) pclose(pipe);
  return text;
}

// A gdb that never got through leaves the world standing for ever: end it, so that the test fails.
void let_nobody_wait(const VirtualBoard& target, const std::string& text) {
  if (text.find("detached") == std::string::npos) kill(target.pid(), SIGKILL);
}

TEST(Gdb, StopsInAFunctionWhileTheWorldWaits) {
  BoardSetup setup{image("calls"), {}};
  setup.gdb_port = 20000 + static_cast<int>(getpid() % 20000);
  setup.silence_s = 1;  // must not count under gdb
  VirtualBoard target(options_for(setup));
  ASSERT_TRUE(target.start());
  std::string text;
  std::thread person([&] {
    text =
        gdb(setup.gdb_port, "calls",
            "-ex 'break counted' -ex 'continue' -ex 'shell sleep 2' -ex 'print $pc' -ex 'backtrace'"
            " -ex 'stepi' -ex 'print $r0' -ex 'delete' -ex 'detach'");
    let_nobody_wait(target, text);
  });
  io::Batch happened;
  bool alive = true;
  for (int k = 1; k <= 3 && alive; ++k) {
    target.run(k * std::int64_t{1'000'000}, {});
    alive = target.arrive(happened).ok();
  }
  person.join();
  EXPECT_TRUE(alive) << target.output();
  EXPECT_NE(text.find("Breakpoint 1, counted"), std::string::npos) << text;
  EXPECT_NE(text.find("main () at"), std::string::npos) << text;
  EXPECT_NE(text.find("= 100"), std::string::npos) << text;
  target.stop(happened);
}

// What a step costs on its own is what the tables say of it alone: neighbours no longer overlap. In
// counted() that is the folding and pipelining of at most two pairs a turn, of which 60 steps see five.
// Where the breakpoint stops it, its first instruction is begun twice: a PUSH of four, 5 cycles.
TEST(Gdb, SteppingNeitherLosesNorAddsCycles) {
  BoardSetup setup{image("stepped"), {}};
  setup.more = R"("ns_per_instruction":0)";
  const auto free_run = run_for(setup, 3).said();
  setup.gdb_port = 20000 + static_cast<int>((getpid() + 14) % 20000);
  VirtualBoard target(options_for(setup));
  ASSERT_TRUE(target.start());
  std::string text;
  std::thread person([&] {
    text = gdb(setup.gdb_port, "stepped",
               "-ex 'break counted' -ex 'continue' -ex 'continue' -ex 'stepi 60' -ex 'print $pc'"
               " -ex 'delete' -ex 'detach'");
    let_nobody_wait(target, text);
  });
  BoardRun run;
  bool alive = true;
  for (int k = 1; k <= 3 && alive; ++k) {
    io::Batch happened;
    target.run(k * std::int64_t{1'000'000}, {});
    alive = target.arrive(happened).ok();
    run.keep(happened);
  }
  person.join();
  io::Batch rest;
  target.stop(rest);
  run.keep(rest);
  ASSERT_TRUE(alive) << target.output();
  const auto stepped = run.said();
  ASSERT_EQ(stepped.size(), free_run.size()) << text;
  ASSERT_EQ(stepped.size(), 5u);
  for (std::size_t n = 0; n < stepped.size(); ++n) {
    const bool by_steps = n == 1;
    EXPECT_TRUE(near(stepped[n], free_run[n],
                     stated(by_steps ? 10.0
                            : n == 0 ? 5.0
                                     : 0.0,
                            "what gdb's breakpoint and steps add")))
        << n << text;
  }
}

TEST(Gdb, InterruptsAnImageThatMostlySleeps) {
  BoardSetup setup{image("sleeper"), {}};
  setup.gdb_port = 20000 + static_cast<int>((getpid() + 7) % 20000);
  VirtualBoard target(options_for(setup));
  ASSERT_TRUE(target.start());
  std::atomic<bool> done{false};
  std::string text;
  std::thread person([&] {  // presses Ctrl-C while it runs
    text = gdb(
        setup.gdb_port, "sleeper",
        "-ex 'shell (sleep 1; kill -INT $PPID) &' -ex 'continue' -ex 'print count' -ex 'detach'");
    let_nobody_wait(target, text);
    done = true;
  });
  io::Batch happened;
  bool alive = true;
  for (std::int64_t k = 1; alive && !done; ++k) {
    target.run(k * 1'000'000, {});
    alive = target.arrive(happened).ok();
  }
  person.join();
  EXPECT_TRUE(alive) << target.output();
  EXPECT_NE(text.find("received signal SIGINT"), std::string::npos) << text;
  EXPECT_NE(text.find("$1 = "), std::string::npos) << text;
}

}  // namespace
}  // namespace whirl::board_test

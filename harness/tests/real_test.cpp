// The program on real images in the real QEMU: bad images by name, faults by address and function,
// silence by the plan's deadline, and digests that repeat, and change with one bit of one sensor.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "base/near.hpp"
#include "harness/tests/real.hpp"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using whirl::near;
using whirl::stated;
using whirl::real::expect_told;
using whirl::real::kSecond;
using whirl::real::Outcome;
using whirl::real::Real;

// Started, sent this signal when the folder of its run is there, and waited for.
int code_after(int signal, const std::string& arguments, const std::string& runs) {
  const pid_t pid = fork();
  if (pid == 0) {
    const std::string line = std::string("exec ") + WHIRL_PROGRAM + " " + arguments + " >/dev/null";
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  while (fs::is_empty(runs)) {
    if (waitpid(pid, &status, WNOHANG) == pid) return -1;  // it ended before its run
    usleep(10'000);
  }
  kill(pid, signal);
  waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST_F(Real, ASignalEndsTheRunInOrder) {
  write("long.lua",
        "plan \"long\" { image = \"flight\", vehicle = \"hp_quad\", timeout = \"10000 s\",\n"
        "run = function(t) t:wait \"9000 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\" end }\n");
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const std::string out = folder_.file("out" + std::to_string(signal));
    fs::create_directories(out + "/runs");
    EXPECT_EQ(
        code_after(signal, "run --out " + out + " " + folder_.file("long.lua"), out + "/runs"), 3)
        << signal;
    std::ifstream in(out + "/runs/latest/run.json");
    const json run = json::parse(in, nullptr, false);
    ASSERT_TRUE(run.is_object()) << signal;
    EXPECT_NE(run["reason"].get<std::string>().find("interrupted by signal"), std::string::npos);
    EXPECT_TRUE(fs::canonical(out + "/runs/latest").string().ends_with("-interrupted"));
  }
}

// As cmake --install lays it out; the checkout's own boards, plug-in and results must play no part.
TEST_F(Real, AnInstalledProgramUsesItsOwnFiles) {
  const std::string prefix = folder_.file("prefix");
  const fs::path share = fs::path(prefix) / "share/whirl";
  fs::create_directories(prefix + "/bin");
  fs::create_directories(prefix + "/lib/whirl");
  fs::create_directories(share / "images");
  fs::create_directories(share / "plant");
  fs::copy_file(WHIRL_PROGRAM, prefix + "/bin/whirl");
  fs::copy_file(WHIRL_PLUGIN, prefix + "/lib/whirl/whirl_board.so");
  fs::copy(std::string(WHIRL_ROOT) + "/test_plans", share / "test_plans",
           fs::copy_options::recursive);
  fs::copy(std::string(WHIRL_ROOT) + "/plant/data", share / "plant/data",
           fs::copy_options::recursive);
  fs::copy_file(std::string(WHIRL_IMAGES) + "/flight.elf", share / "images/renamed.elf");
  write("p.lua",
        std::string("plan \"p\" { image = \"renamed\", vehicle = \"hp_quad\", timeout = ") +
            "\"3 s\", run = function(t) " + kSecond + " end }");
  unsetenv("WHIRL_RESULTS");
  const std::string go = "cd " + folder_.path() + " && " + prefix + "/bin/whirl run p.lua";
  EXPECT_EQ(std::system((go + " >/dev/null").c_str()), 0);
  EXPECT_TRUE(fs::exists(folder_.file("whirl-results/runs/latest/index.html")));
  fs::remove(share / "test_plans/boards/px4fmu_v1.lua");  // its own is the only one
  EXPECT_EQ(WEXITSTATUS(std::system((go + " >/dev/null 2>&1").c_str())), 2);
  fs::remove_all(share);
  EXPECT_EQ(WEXITSTATUS(std::system((go + " >/dev/null 2>&1").c_str())), 2);
}

// Neither the program nor the plug-in knows where it was built.
TEST_F(Real, NothingOfTheCheckoutsPathIsCompiledIn) {
  for (const char* file : {WHIRL_PROGRAM, WHIRL_PLUGIN}) {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    ASSERT_GT(bytes.size(), 100'000u);
    EXPECT_EQ(bytes.find(std::string(WHIRL_ROOT) + "/"), std::string::npos) << file;
  }
}

TEST_F(Real, OutputThatIsLostIsNoPass) {
  write("p.lua",
        std::string("plan \"p\" { image = \"flight\", vehicle = \"hp_quad\", timeout = \"3 s\",") +
            " run = function(t) " + kSecond + " end }");
  const std::string line = std::string(WHIRL_PROGRAM) + " run " + folder_.file("p.lua");
  EXPECT_EQ(WEXITSTATUS(std::system((line + " >/dev/full 2>/dev/null").c_str())), 3);
  EXPECT_EQ(WEXITSTATUS(std::system((line + " >&- 2>/dev/null").c_str())), 3);
  EXPECT_EQ(WEXITSTATUS(std::system((line + " >/dev/null 2>&- <&-").c_str())), 0);
  // A parent may have had SIGCHLD ignored.
  EXPECT_EQ(WEXITSTATUS(std::system(("timeout 60 env --ignore-signal=CHLD " + line + " " +
                                     folder_.file("p.lua") + " --jobs 2 >/dev/null")
                                        .c_str())),
            0);
}

// What runs in processes of their own is told, remembered and merged like what runs here.
TEST_F(Real, JobsComeBackWhole) {
  const std::string head = "vehicle = \"hp_quad\", timeout = \"3 s\", run = function(t) ";
  write("a.lua", "plan \"a\" { image = \"flight\", " + head + kSecond + " end }");
  write("b.lua", "plan \"b\" { image = \"flight\", " + head +
                     "t:wait \"1 s\" t:expect(t:value \"height\"):at_least \"50 m\" end }");
  write("c.lua", "plan \"c\" { image = \"nowhere\", " + head + kSecond + " end }");
  const std::string out = folder_.file("results");
  const std::string files =
      folder_.file("a.lua") + " " + folder_.file("b.lua") + " " + folder_.file("c.lua");
  const Outcome apart = whirl("run --jobs 2 " + files);
  expect_told(apart, 2, "1 passed, 1 failed, 1 bad input");
  EXPECT_NE(apart.text.find("FAIL b"), std::string::npos) << apart.text;
  std::ifstream in(out + "/junit.xml");
  const std::string merged((std::istreambuf_iterator<char>(in)), {});
  for (const char* suite : {"name=\"a\"", "name=\"b\"", "name=\"c\"", "at least 50 m", "nowhere"}) {
    EXPECT_NE(merged.find(suite), std::string::npos) << suite;
  }
  expect_told(whirl("history"), 0, "a: tilt");
  EXPECT_EQ(std::distance(fs::directory_iterator(out + "/runs"), fs::directory_iterator()), 4);
}

// Two boards: what joins them wrongly, and what no board of them is meant by.
TEST_F(Real, NodesThatAreWrongAreRefused) {
  const std::string esc = "image = 'esc', board = 'esc32v2' }";
  const std::string nodes = "nodes = { { name = 'a', " + esc + ", { name = 'b', " + esc + " }";
  const auto refuse = [&](const std::string& wires, const std::string& body,
                          const std::string& words) {
    write("n.lua", "plan 'n' { " + nodes + ", " + wires +
                       " stand = { prop = 'hk_10x4.5', supply = '16 V' }," +
                       " timeout = '2 s', run = function(t) t:wait '10 ms' " + body + " end }");
    expect_told(whirl("run " + folder_.file("n.lua")), 2, words);
  };
  const std::string good = "{ from = 'a.usart1', to = 'b.usart1' }";
  refuse("wires = { { from = 'a.usart2', to = 'b.usart1' } },", "",
         "a.usart2 has no serial device");
  refuse("wires = { " + good + ", " + good + " },", "", "a.usart1 is wired twice");
  refuse("wires = { { from = 'a.usart1', to = 'a.usart1' } },", "", "a wire joins two boards");
  refuse("wires = { { from = 'c.usart1', to = 'a.usart1' } },", "",
         "'c.usart1' is no UART of a node");
  refuse("", "t:budget('fw::esc::control_task') { response = '1 s' }",
         "names no board of this plan");
  refuse("", "t:fault { kind = 'uart_loss' }", "is on one board of several");
  refuse("", "t:fault { kind = 'supply_dip', motor = 1, value = '1 V' }", "has no place");
  refuse("", "t:budget('b/') { busy = '9 %' }", "names no board of this plan");
  write("n.lua",
        "plan 'n' { nodes = { { name = 'a', " + esc +
            ", { name = 'b', image = 'timing_f405', board = 'timing_f405' } }, wires = { { from = "
            "'a.usart1', to = 'b.usart2' } }, stand = { prop = 'hk_10x4.5', supply = '16 V' }, "
            "run = function(t) end }");
  expect_told(whirl("run " + folder_.file("n.lua")), 2, "speak at different rates");
  expect_told(whirl("run --gdb " + folder_.file("n.lua")), 2, "--gdb holds one board");
}

// Neither an ESC without a motor, nor a motor that nothing can ever turn.
TEST_F(Real, MotorsAndEscsMustFit) {
  std::ifstream in(std::string(WHIRL_ROOT) + "/test_plans/vehicles/hp_quad.lua");
  std::string quad((std::istreambuf_iterator<char>(in)), {});
  const auto way_up = quad.find("../propellers");
  ASSERT_NE(way_up, std::string::npos);
  quad.replace(way_up, 2, std::string(WHIRL_ROOT) + "/test_plans");
  const auto arm = quad.find("arm =");
  ASSERT_NE(arm, std::string::npos);
  const auto with = [&](const std::string& motors) {
    std::string text = quad;
    text.replace(arm, text.find('\n', arm) - arm, "motors = { " + motors + " },");
    write("few.lua", text);
    return run("flight", kSecond, folder_.file("few.lua"));
  };
  const auto motor = [](int i) {
    return "{ place = { forward = '" + std::to_string(20 * i) +
           " cm', right = '0 m' }, spin = 'ccw' }, ";
  };
  expect_told(with(motor(0)), 2, "ESC of motor 2 has no motor");
  expect_told(with(motor(0) + motor(1) + motor(2) + motor(3) + motor(4)), 2, "motor 5 has no ESC");
}

TEST_F(Real, AMissingImageIsNamed) {
  expect_told(run("nowhere", kSecond), 2, "'nowhere' is not there");
}

TEST_F(Real, AnImageForAnotherCpuIsRefused) {
  fs::copy_file("/proc/self/exe", folder_.file("host.elf"));
  expect_told(run("host.elf", kSecond), 2, "host.elf: not for a 32-bit little-endian CPU");
}

TEST_F(Real, AFileThatIsNoImageIsRefused) {
  write("text.elf", "not an ELF at all\n");
  expect_told(run("text.elf", kSecond), 2, "text.elf: not an ELF file");
}

// A word beyond the end of the 1 MiB flash: the program header's size is moved, nothing else.
TEST_F(Real, AnImageTooLargeForTheFlashIsRefused) {
  std::ifstream in(std::string(WHIRL_IMAGES) + "/flight.elf", std::ios::binary);
  std::string elf((std::istreambuf_iterator<char>(in)), {});
  ASSERT_GT(elf.size(), 52u);
  const auto word = [&](std::size_t at) {
    std::uint32_t x;
    std::memcpy(&x, &elf[at], 4);
    return x;
  };
  const std::size_t header = word(28);  // e_phoff; p_filesz at 16, p_memsz at 20
  elf.resize(std::max<std::size_t>(elf.size(), word(header + 4) + (2u << 20)));
  const std::uint32_t size = (1u << 20) + 4;
  for (std::size_t at : {header + 16, header + 20}) std::memcpy(&elf[at], &size, 4);
  write("large.elf", elf);
  expect_told(run("large.elf", kSecond), 2, "large.elf: does not fit into flash: 1048580 bytes");
}

TEST_F(Real, ANegativeMassIsRefused) {
  std::ifstream in(std::string(WHIRL_ROOT) + "/test_plans/vehicles/hp_quad.lua");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const auto at = text.find("mass = \"900 g\"");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 14, "mass = \"-1 kg\"");
  write("heavy.lua", text);
  expect_told(run("flight", kSecond, "heavy.lua"), 2, "mass: '-1 kg' must be positive");
}

TEST_F(Real, AHardFaultIsNamedWithItsFunction) {
  const Outcome outcome = run("hardfault", kSecond);
  EXPECT_EQ(outcome.code, 1) << outcome.text;
  const std::string reason = outcome.run.value("reason", "");
  EXPECT_NE(reason.find("Fault"), std::string::npos) << reason;
  EXPECT_NE(reason.find("fault_on_purpose"), std::string::npos) << reason;
  EXPECT_NE(reason.find("0x080"), std::string::npos) << reason;
}

TEST_F(Real, AHangingImageIsResetByItsWatchdogAndFailsByName) {
  const Outcome outcome = run("starved", kSecond);
  expect_told(outcome, 1, "reset by the independent watchdog");
  // 500 counts of LSI / 16 at 32 kHz nominal: 0.25 s after its start.
  EXPECT_TRUE(near(outcome.run.value("virtual_s", 0.0), 0.25,
                   stated(0.01, "its start, and a step of 1 ms")));
}

TEST_F(Real, AnImageThatNeverFeedsTheBusFailsByItsDeadline) {
  const Outcome outcome =
      run("silent",
          "t:bus { device = \"esc1\", direction = \"write\", period = \"20 ms\","
          " tolerance = \"1 ms\" } t:wait \"1 s\"");
  expect_told(outcome, 1, "esc1 write period deviation");
}

TEST_F(Real, WhatTheBoardSaysBeforeItsFirstStepIsKept) {
  const Outcome outcome = run("sleeper", "t:wait \"5 ms\"");
  const std::string said = whirl::text_of(outcome.run["findings"]);
  EXPECT_NE(said.find("the image has no function 'fw::imu_task'"), std::string::npos) << said;
}

TEST_F(Real, AnImageThatSleepsForEverFailsAtTheTimeoutInVirtualTime) {
  const Outcome outcome =
      run("sleeper", "t:wait_until(function(s) return s.told_armed == 1 end, \"1 min\")");
  expect_told(outcome, 1, "timeout of 3 s virtual time");
  EXPECT_TRUE(near(outcome.run.value("virtual_s", 0.0), 3.0, stated(1e-9, "at once")));
}

// What gdb says that stops a board in this function and lets it go, and the code with which the run ends.
std::string gdb_at(const std::string& function, const std::string& image,
                   const std::string& arguments) {
  const std::string port = std::to_string(20000 + getpid() % 20000);
  const std::string command =
      std::string("timeout 100 ") + WHIRL_PROGRAM + " run --gdb --gdb-port " + port + " " +
      arguments + " >/dev/null 2>&1 & whirl=$!; " + "gdb-multiarch -batch -nx " + WHIRL_IMAGES +
      "/" + image + ".elf -ex 'set tcp connect-timeout 60' -ex 'target remote 127.0.0.1:" + port +
      "' -ex 'hbreak " + function +
      "' -ex continue -ex 'shell sleep 2' -ex backtrace -ex 'delete'"
      " -ex detach 2>&1; wait $whirl; echo code $?";
  std::FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  char piece[4096];
  for (std::size_t n; (n = std::fread(piece, 1, sizeof piece, pipe)) > 0;) text.append(piece, n);
  pclose(pipe);
  return text;
}

// gdb stops in a task, reads the world's state from the image, and lets it fly on.
TEST_F(Real, GdbStopsInATaskAndTheRunGoesOnAfterIt) {
  write("p.lua", std::string("plan \"real\" { image = \"flight\", vehicle = \"hp_quad\",\n"
                             "run = function(t) ") +
                     kSecond + " end }\n");
  const std::string text = gdb_at("fw::attitude_task", "flight", folder_.file("p.lua"));
  EXPECT_NE(text.find("#0  fw::attitude_task"), std::string::npos) << text;
  EXPECT_NE(text.find("code 0"), std::string::npos) << text;
}

// The other board has no gdb, and waits with the world: what it is asked at 0.2 s it has not missed.
TEST_F(Real, GdbHoldsOneBoardOfSeveral) {
  const std::string esc = "image = 'esc', board = 'esc32v2' }";
  write("n.lua", "plan 'n' { nodes = { { name = 'a', " + esc + ", { name = 'b', " + esc +
                     " }, wires = { { from = 'a.usart1', to = 'b.usart1' } }, "
                     "stand = { prop = 'hk_10x4.5', supply = '16 V' }, timeout = '2 s', "
                     "run = function(t) t:wait '200 ms' t:ask('get mode', '^mode') end }");
  const std::string plan = folder_.file("n.lua");
  const std::string text = gdb_at("fw::esc::control_task", "esc", "--gdb-board b " + plan);
  EXPECT_NE(text.find("#0  fw::esc::control_task"), std::string::npos) << text;
  EXPECT_NE(text.find("code 0"), std::string::npos) << text;
  expect_told(whirl("run --gdb " + plan), 2, "--gdb-board with one of a, b");
  expect_told(whirl("run --gdb --gdb-board c " + plan), 2, "no board 'c'");
}

// The process finds it, from its own copy of the description; the line is that of the file.
TEST_F(Real, WhatThePartDoesNotHaveIsToldWithItsLine) {
  const auto said = [this](const std::string& entry) {
    write("odd.lua",
          "return { board = 'odd', mcu = 'stm32f405rg', hse = '8 MHz',\n" + entry + " }");
    write("p.lua",
          "plan \"real\" { image = \"flight\", board = \"odd.lua\", vehicle = \"hp_quad\","
          " run = function(t) t:wait \"5 ms\" end }\n");
    return whirl("run " + folder_.file("p.lua"));
  };
  std::string escs;
  for (int n = 1; n <= 4; ++n) {
    const std::string number = std::to_string(n);
    escs += "{ name = 'esc" + number +
            "', type = 'esc_i2c', bus = 'i2c3', address = " + std::to_string(40 + n) +
            ", motor = " + number + " }, ";
  }
  const std::string devices = "devices = { " + escs + "\n";
  expect_told(said(devices + "},\npins = { { name = 'led', pin = 'PZ1' } }"), 2,
              "odd.lua:4: pin led: the part has no pin 'PZ1'");
  expect_told(said(devices + "{ name = 'far', type = 'serial', bus = 'usart9',\n" +
                   "baud = '9600 baud' } }"),
              2, "odd.lua:3: far: the part has no bus 'usart9'");
}

TEST_F(Real, ADeviceThatTheBoardDoesNotKnowIsNamed) {
  expect_told(run("flight", "t:bus { device = \"esc9\" }"), 2, "unknown device 'esc9'");
}

TEST_F(Real, TheDigestRepeatsAndChangesWithOneBitOfOneSensorReading) {
  const Outcome once = run("flight", kSecond), again = run("flight", kSecond);
  ASSERT_EQ(once.code, 0) << once.text;
  EXPECT_EQ(once.run["digest"], again.run["digest"]);
  // One bit of one byte of the one burst within this millisecond.
  const Outcome flipped =
      run("flight", std::string("t:fault { kind = \"spi_flip\", device = \"imu\","
                                " start = \"500 ms\", duration = \"1 ms\", value = 8 * 14 }") +
                        kSecond);
  ASSERT_EQ(flipped.code, 0) << flipped.text;
  EXPECT_NE(once.run["digest"], flipped.run["digest"]);
}

}  // namespace

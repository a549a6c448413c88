// A run's wires, drawn, replayed through libsigrok and judged again: the same verdicts as the run itself; and with an
// edge lost on the way, none that was not seen.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/json_text.hpp"
#include "base/near.hpp"
#include "base/output_file.hpp"
#include "base/scratch_folder.hpp"
#include "base/whole_file.hpp"

namespace whirl {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class CopperRun : public testing::Test {
 protected:
  CopperRun() { setenv("WHIRL_RESULTS", folder_.file("results").c_str(), 1); }

  static std::string shell(const std::string& arguments, int expected) {
    std::FILE* pipe = popen((std::string(WHIRL_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
    std::string text;
    char piece[4096];
    for (std::size_t n; (n = std::fread(piece, 1, sizeof piece, pipe)) > 0;) text.append(piece, n);
    const int status = pclose(pipe);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, expected) << arguments << "\n" << text;
    return text;
  }
  // Its folder.
  std::string run(const std::string& plan, const std::string& more = "", int expected = 0) {
    shell("run " + std::string(WHIRL_ROOT) + "/test_plans/" + plan + more, expected);
    return fs::canonical(folder_.file("results/runs/latest")).string();
  }
  static json report(const std::string& run) {
    return parse_json(read_whole_file(run + "/run.json").value());
  }
  // Bytes, addresses and directions; the times differ by what a sample rate can tell.
  static std::string transfers(const std::string& run) {
    const std::string csv = read_whole_file(run + "/bus.csv").value();
    std::string rows;
    for (std::size_t at = 0; at < csv.size();) {
      const std::size_t end = csv.find('\n', at), second = csv.find(',', csv.find(',', at) + 1);
      rows += csv.substr(second, end - second) + "\n";
      at = end + 1;
    }
    return rows;
  }

  ScratchFolder folder_;
};

void expect_same_verdicts(const json& own, const json& seen) {
  ASSERT_EQ(own["expectations"].size(), seen["expectations"].size());
  for (std::size_t i = 0; i < own["expectations"].size(); ++i) {
    const json &a = own["expectations"][i], &b = seen["expectations"][i];
    EXPECT_EQ(a["name"], b["name"]);
    EXPECT_EQ(a["verdict"], b["verdict"]) << a["name"];
    if (!a["measured"].is_number()) continue;
    const double unit_ns = a["unit"] == "us" ? 1e3 : a["unit"] == "ms" ? 1e6 : 1e9;
    EXPECT_TRUE(
        near(b["measured"].get<double>() * unit_ns, a["measured"].get<double>() * unit_ns,
             stated(a["unit"] == "us" || a["unit"] == "ms" ? 41.0 : 0.0,
                    "two edges, each told to a sample of 20 ns; what is no bus's is equal")))
        << a["name"];
  }
}

TEST_F(CopperRun, TheThrustRiseHasTheSameVerdictsAndTransfers) {
  const std::string own = run("esc/rise.lua --only thrust_rise");
  shell("export " + own + " --vcd", 0);
  const std::string seen = run("esc/rise.lua --only thrust_rise",
                               " --copper " + own + "/wires.vcd --copper-rate '10 MHz'");
  expect_same_verdicts(report(own), report(seen));
  EXPECT_EQ(transfers(seen), transfers(own));
  EXPECT_NE(report(seen)["digest"],
            report(own)["digest"]);  // they are not the board's own messages
}

// One clock of one read of esc2 is taken out, as a glitch or a slow sampling would.
std::string without_one_clock(const std::string& vcd, std::int64_t after_ns) {
  const std::size_t named = vcd.find(" i2c3_scl $end");
  const std::string code =
      vcd.substr(vcd.rfind(' ', named - 1) + 1, named - vcd.rfind(' ', named - 1) - 1);
  std::size_t at = vcd.find("\n#" + std::to_string(after_ns / 100'000'000));
  while (std::stoll(vcd.substr(at + 2, 20)) < after_ns) at = vcd.find("\n#", at + 1);
  std::string less = vcd;
  for (int clock = 0; clock < 3; ++clock) at = less.find("\n1" + code + "\n", at + 1);
  less.replace(at, 2 + code.size(), "");
  const std::size_t fall = less.find("\n0" + code + "\n", at);
  less.replace(fall, 2 + code.size(), "");
  return less;
}

TEST_F(CopperRun, TheBusesOfAFlightControllerHaveTheSameVerdictsAndALostClockIsNotJudged) {
  const std::string own = run("flight/boot.lua");
  shell("export " + own + " --vcd", 0);
  const std::string seen = run("flight/boot.lua", " --copper " + own + "/wires.vcd");
  expect_same_verdicts(report(own), report(seen));
  EXPECT_EQ(transfers(seen), transfers(own));
  const std::string vcd = read_whole_file(own + "/wires.vcd").value();
  ASSERT_TRUE(write_text(folder_.file("lost.vcd"), without_one_clock(vcd, 1'000'000'000)));
  const json lost = report(run("flight/boot.lua", " --copper " + folder_.file("lost.vcd"), 3));
  int inconclusive = 0;
  for (const json& e : lost["expectations"]) {
    const std::string name = e["name"];
    const bool of_bus = name.starts_with("esc");
    EXPECT_EQ(e["verdict"], of_bus ? "inconclusive" : "pass") << name;
    inconclusive += e["verdict"] == "inconclusive";
  }
  EXPECT_EQ(inconclusive, 8);  // a period and the NACKs of four ESCs on that bus
  ASSERT_GE(lost["findings"].size(), 1u);
  EXPECT_NE(lost["findings"].dump().find("clocks between START and STOP are no multiple of nine"),
            std::string::npos);
}

// The throttle line of a stand, named as a pin: its pulses are judged by the board's own edges and by the capture's.
TEST_F(CopperRun, PulsesOnAPinHaveTheSameVerdicts) {
  std::string board =
      read_whole_file(std::string(WHIRL_ROOT) + "/test_plans/boards/esc32v2.lua").value();
  const std::size_t watch = board.find("  watch =");
  board.insert(watch, "  pins = { { name = \"throttle_pin\", pin = \"PA8\" } },\n");
  ASSERT_TRUE(write_text(folder_.file("b.lua"), board));
  const std::string plan = folder_.file("p.lua");
  ASSERT_TRUE(write_text(
      plan, "plan \"p\" { image = \"" + std::string(WHIRL_ROOT) +
                "/build/firmware/esc.elf\", board = \"b.lua\", timeout = \"3 s\",\n"
                "stand = { prop = \"hk_10x4.5\", battery = \"4s_2200\", throttle = \"pwm\" },\n"
                "run = function(t) t:wait \"100 ms\"\n"
                "t:bus { pin = \"throttle_pin\", period = \"20 ms\", tolerance = \"1 us\", "
                "high = \"1 ms\", during = \"500 ms\" }\n"
                "t:wait \"600 ms\" end }\n"));
  shell("run " + plan, 0);
  const std::string own = fs::canonical(folder_.file("results/runs/latest")).string();
  shell("export " + own + " --vcd", 0);
  shell("run " + plan + " --copper " + own + "/wires.vcd", 0);
  const std::string seen = fs::canonical(folder_.file("results/runs/latest")).string();
  expect_same_verdicts(report(own), report(seen));
  ASSERT_EQ(report(own)["expectations"].size(), 2u);
}

TEST_F(CopperRun, WhatIsNoCaptureOfThisBoardIsRefusedInOneLine) {
  ASSERT_TRUE(write_text(folder_.file("words.vcd"), "these are words\n"));
  const std::string plan =
      "run " + std::string(WHIRL_ROOT) + "/test_plans/esc/rise.lua --only thrust_rise --copper ";
  EXPECT_NE(shell(plan + folder_.file("words.vcd"), 2).find("words.vcd: "), std::string::npos);
  EXPECT_NE(shell(plan + folder_.file("nowhere.vcd"), 2).find("cannot be opened"),
            std::string::npos);
  const std::string strange =
      "$timescale 1 ns $end\n$var wire 1 ! D0 $end\n$enddefinitions $end\n#0\n1!\n#5\n0!\n";
  ASSERT_TRUE(write_text(folder_.file("strange.vcd"), strange));
  EXPECT_NE(shell(plan + folder_.file("strange.vcd"), 2).find("has no wire of this board"),
            std::string::npos);
  EXPECT_NE(shell(plan + "x.vcd --seeds 1..3", 2).find("is a capture of one run"),
            std::string::npos);
}

}  // namespace
}  // namespace whirl

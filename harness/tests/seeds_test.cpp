// whirl run --seeds: each plan on each seed, and the spread of what it measured.
#include <gtest/gtest.h>

#include "harness/cli/composition.hpp"
#include "harness/cli/seeds.hpp"
#include "harness/tests/fake.hpp"
#include "harness/tests/plans.hpp"

namespace whirl::test {
namespace {

const std::string kDrawn =
    "t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\" "
    "t:expect(t:quantity(t:drawn(\"1 s\", \"2 s\")), \"drawn\"):at_least(0)";

TEST(Seeds, AreReadAsOneWritesThem) {
  EXPECT_EQ(cli::read_seeds("2..4").value(), (std::vector<std::uint64_t>{2, 3, 4}));
  EXPECT_EQ(cli::read_seeds("7").value(), (std::vector<std::uint64_t>{7}));
  EXPECT_EQ(cli::read_seeds("1,5..6,0").value(), (std::vector<std::uint64_t>{1, 5, 6, 0}));
  EXPECT_EQ(cli::read_seeds("18446744073709551614..18446744073709551615").value().size(), 2U);
  EXPECT_EQ(cli::read_seeds("1..10000").value().size(), cli::kMost_seeds);
  for (const char* bad :
       {"", ",", "1,", "1,,2", "x", "-1", "3..2", "1..", "..2", "1...3", "1,1", "2..4,3",
        "0..10000", "0..5000,5001..10000", "18446744073709551616", " 1"}) {
    EXPECT_FALSE(cli::read_seeds(bad).ok()) << bad;
    EXPECT_EQ(whirl(FakeRoot(), {"run", "--seeds", bad}).code, 2) << bad;
  }
}

TEST(Seeds, EachIsARunAndTheSpreadIsFiled) {
  FakeRoot root;
  root.write("test_plans/a.lua", plan_text(kDrawn));
  const Outcome outcome = whirl(root, {"run", "--seeds", "5,3..4"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("on 3 seeds: 3 passed"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("3 passed\n"), std::string::npos) << outcome.out;
  const std::string table = root.read("results/seeds/p.csv");
  for (const char* line : {"\"tilt\",3,", "\"tilt\",4,", "\"tilt\",5,", "\"drawn\",5,"}) {
    EXPECT_NE(table.find(line), std::string::npos) << table;
  }
  EXPECT_NE(root.read("results/seeds/p.html").find("3 of 3 seeds passed"), std::string::npos);
  // What one seed alone gives is what it gives among others.
  EXPECT_EQ(whirl(root, {"run", "--seed", "4"}).code, 0);
  const std::string one = root.read("results/runs/latest/run.json");
  const auto at = table.find("\"drawn\",4,") + 10;
  EXPECT_NE(one.find("\"measured\": " + table.substr(at, 6)), std::string::npos) << one;
}

TEST(Seeds, OneThatFailsFailsTheCommandAndIsNamed) {
  FakeRoot root;
  root.write("test_plans/a.lua",
             plan_text("t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\" "
                       "t:expect(t:quantity(t:drawn(\"1 s\", \"2 s\")), \"drawn\"):at_most(1.5)"));
  const Outcome outcome = whirl(root, {"run", "--seeds", "1..8"});
  EXPECT_EQ(outcome.code, 1) << outcome.out;
  const std::string table = root.read("results/seeds/p.csv");
  EXPECT_NE(table.find(",fail"), std::string::npos) << table;
  EXPECT_NE(table.find(",pass"), std::string::npos) << table;
}

// Its own constants, and not those of another copy of the hardware.
TEST(Seeds, EachTakesWhatItsOwnCalibrationFound) {
  FakeRoot root;
  root.write("test_plans/a.lua",
             "local c = include 'include/x_calibration.lua'\n" +
                 plan_text("t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\" "
                           "t:expect(t:quantity(c .. \" s\"), \"c\"):at_most(7)"));
  root.write("test_plans/include/x_calibration.lua", "return 1");
  root.write("results/calibrations/x/seed_3/constants.lua", "return 3");
  root.write("results/calibrations/x/seed_9/constants.lua", "return 9");
  const std::string folder = root.path() + "/results/calibrations/x";
  EXPECT_EQ(whirl(root, {"run", "--seeds", "3,9"}).code, 0);
  EXPECT_EQ(whirl(root, {"run", "--seeds", "3,9", "--calibrations", folder}).code, 1);
  EXPECT_NE(root.read("results/seeds/p.csv").find("\"c\",9,9,"), std::string::npos);
  EXPECT_EQ(whirl(root, {"run", "--seed", "3", "--calibrations", folder + "/"}).code, 0);
  EXPECT_NE(root.read("results/runs/latest/run.json").find("constants.lua fnv1a64"),
            std::string::npos);
  const Outcome missing = whirl(root, {"run", "--seed", "4", "--calibrations", folder});
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.out.find("the ESC of seed 4 was not calibrated"), std::string::npos)
      << missing.out << missing.err;
  EXPECT_EQ(whirl(root, {"run", "--calibrations", folder}).code, 2);
}

TEST(Seeds, LimitsAreProposedFromTheWorst) {
  FakeRoot root;
  root.write("test_plans/a.lua", plan_text(kDrawn));
  const Outcome outcome = whirl(root, {"limits", "--seeds", "1..3"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("; proposed at most "), std::string::npos) << outcome.out;
  for (const char* bad : {"0 %", "2000 %", "x", "3 m"}) {
    EXPECT_EQ(whirl(root, {"limits", "--seeds", "1..2", "--margin", bad}).code, 2) << bad;
  }
  EXPECT_EQ(whirl(root, {"limits"}).code, 2);
}

// One that a later plan of that name had replaced would be lost, and with it a failure.
TEST(Seeds, PlansOfOneNameHaveFilesOfTheirOwn) {
  FakeRoot root;
  root.write("test_plans/a.lua", plan_text(kDrawn));
  root.write("test_plans/b.lua", plan_text(kDrawn));
  EXPECT_EQ(whirl(root, {"run", "--seeds", "1..2"}).code, 0);
  EXPECT_NE(root.read("results/seeds/p.csv"), "");
  EXPECT_NE(root.read("results/seeds/p-2.csv"), "");
}

TEST(Seeds, AreSaidOnce) {
  FakeRoot root;
  root.write("test_plans/a.lua", plan_text(kDrawn));
  EXPECT_EQ(whirl(root, {"run", "--seeds", "1..2", "--seed", "1"}).code, 2);
  EXPECT_EQ(whirl(root, {"run", "--seeds", "1..2", "--set", "plan.seed=1"}).code, 2);
  EXPECT_EQ(whirl(root, {"run", "--seeds", "1..2", "--gdb"}).code, 2);
}

TEST(Target, WhatNoBenchCanRunIsSaidBeforeAnythingTurns) {
  const FakeRoot root;
  root.write("p.lua", plan_text("t:wait \"10 ms\" t:expect(t:value \"thrust\"):at_least \"0 N\""));
  const std::string plan = root.path() + "/p.lua";
  const auto refused = [&](std::vector<std::string> words, const std::string& why) {
    words.insert(words.begin(), {"run", plan});
    const Outcome outcome = whirl(root, words);
    EXPECT_EQ(outcome.code, 2) << why;
    EXPECT_NE((outcome.out + outcome.err).find(why), std::string::npos)
        << outcome.out << outcome.err;
  };
  refused({"--target", "foo"}, "'foo' is no target");
  refused({"--target", "bench/"}, "is no target");
  refused({"--target", "bench/b", "--twice"}, "--twice");
  refused({"--target", "bench/b", "--gdb"}, "--gdb");
  // In processes of their own two runs would know of no bench, and pass on the virtual board.
  refused({"--target", "bench/b", "--seeds", "1..2"}, "--seeds");
  refused({"--target", "bench/b", "--jobs", "2"}, "--jobs");
  refused({"--target", "bench/b"}, "'b' is not there");
  // The plan has a vehicle: each of its board's devices is played by somebody.
  const std::string bench =
      R"(return { bench = "b", board = "fake", late = "1 ms", late_share = "1 %",
    links = { { name = "bus", bus = "can2", interface = "can0" } },
    safety = { phrase = "clear", longest = "9 s" } })";
  root.write("test_plans/benches/b.lua", bench);
  refused({"--target", "bench/b"}, "nothing plays ");
  const auto with_pod = [&](const std::string& link) {
    std::string text = bench;
    const std::string bus = R"(bus = "can2", interface = "can0")";
    root.write("test_plans/benches/b.lua", text.replace(text.find(bus), bus.size(), link));
  };
  root.write("test_plans/boards/none.lua",
             R"(return { board = "none", mcu = "stm32f405rg", hse = "8 MHz" })");
  with_pod(R"(pod = "none", path = "/dev/ttyUSB0")");
  refused({"--target", "bench/b"}, "has no pod_parts: it is no pod's board");
  root.write("test_plans/boards/pod.lua",
             R"(return { board = "pod", mcu = "stm32f405rg", hse = "8 MHz",
    devices = { { name = "host", type = "pod_parts" } } })");
  with_pod(R"(pod = "pod", interface = "can0")");
  refused({"--target", "bench/b"}, "the host of pod is on a serial line");
  with_pod(R"(pod = "pod", path = "/dev/ttyUSB0")");
  refused({"--target", "bench/b"}, "nothing plays ");  // the radio, whatever else
  refused({"--arm", "clear"}, "--target");
}

// Of a bench's run: how late its host may be.
TEST(Target, HowLateABenchMayBeThePlanSaysOrElseTheBench) {
  const FakeRoot root;
  root.write("test_plans/boards/pod.lua",
             R"(return { board = "pod", mcu = "stm32f405rg", hse = "8 MHz",
    devices = { { name = "host", type = "pod_parts" } } })");
  root.write("test_plans/benches/b.lua",
             R"(return { bench = "b", board = "fake", late = "1 ms", late_share = "3 %",
    links = { { name = "pod", pod = "pod", path = "/dev/none" },
              { name = "radio", bus = "usart2", path = "/dev/none/2" } },
    safety = { phrase = "clear", longest = "9 s" } })");
  const auto asked = [&](const std::string& keys) {
    std::pair<std::int64_t, double> seen{-1, -1.0};
    cli::Composition composition = fake_composition(root.path());
    composition.target = [&, inner = composition.target](const cli::Setup& setup) {
      if (setup.bench != nullptr) seen = {setup.bench->late_ns, setup.bench->late_share};
      return inner(setup);
    };
    root.write("p.lua", plan_text("t:wait \"10 ms\" t:expect(t:value \"thrust\"):at_least \"0 N\"",
                                  "flight", keys));
    std::vector<std::string> words{"whirl", "run",  root.path() + "/p.lua", "--target", "bench/b",
                                   "--arm", "clear"};
    std::vector<char*> argv;
    argv.reserve(words.size());
    for (std::string& word : words) argv.push_back(word.data());
    EXPECT_EQ(cli::run_program(static_cast<int>(argv.size()), argv.data(), composition), 0) << keys;
    return seen;
  };
  using Seen = std::pair<std::int64_t, double>;
  EXPECT_EQ(asked(""), Seen(1'000'000, 0.03));
  EXPECT_EQ(asked("late = \"200 us\","), Seen(200'000, 0.03));
  EXPECT_EQ(asked("late_share = \"0.5 %\","), Seen(1'000'000, 0.005));
  EXPECT_EQ(asked("late = \"2 ms\", late_share = \"0 %\","), Seen(2'000'000, 0.0));
}

TEST(Target, HowLateIsATimeAndAShare) {
  const auto refused = [](const std::string& keys, const std::string& words) {
    const Outcome outcome = run_plan(plan_text("t:wait \"10 ms\"", "flight", keys)).outcome;
    EXPECT_EQ(outcome.code, 2) << keys;
    EXPECT_NE((outcome.out + outcome.err).find(words), std::string::npos) << outcome.err;
  };
  refused("late = \"2 %\",", "late");
  refused("late_share = \"120 %\",", "late_share");
  refused("late_share = \"1 ms\",", "late_share");
}

}  // namespace
}  // namespace whirl::test

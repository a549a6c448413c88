// The program as a user meets it: plans in, verdicts, exit codes, messages and results out.
#include <gtest/gtest.h>

#include "base/json_text.hpp"
#include "base/near.hpp"
#include "harness/tests/plans.hpp"

namespace whirl::test {
namespace {

TEST(Program, AGoodPlanPassesAndExplainsItself) {
  const Ran ran = run_plan(plan_text(R"(
    t:wait "300 ms"
    local up = t:record("height", "3 s", function() t:command { takeoff = "1.1 m" } end)
    t:expect(up:rise_time()):at_most "500 ms"
    t:expect(up:final()):within("1.0 m", "1.2 m"))"));
  EXPECT_EQ(ran.outcome.code, 0) << ran.outcome.out << ran.outcome.err;
  EXPECT_EQ(ran.run["verdict"], "pass");
  const json& rise = expectation(ran.run, "height rise time");
  // tau ln 9 of a first-order lag with tau = 200 ms.
  EXPECT_TRUE(near(rise["measured"], 200.0 * std::log(9.0), stated(0.1, "1 ms samples")));
  EXPECT_EQ(rise["unit"], "ms");
  EXPECT_EQ(rise["limit"], 500.0);
  EXPECT_TRUE(near(rise["margin"], 500.0 - 200.0 * std::log(9.0), stated(0.1, "1 ms samples")));
  EXPECT_EQ(rise["place"], "p.lua:6");
  for (const char* key :
       {"plan", "seed", "digest", "virtual_s", "host_s", "speed_factor", "versions"}) {
    EXPECT_TRUE(ran.run.contains(key)) << key;
  }
}

TEST(Program, AFailedExpectationIsExitCodeOneAndTheRestIsStillMeasured) {
  const Ran ran = run_plan(plan_text(R"(
    t:wait "1 s"
    t:expect(t:value("thrust")):at_most "1 N"
    t:expect(t:value("thrust"), "second"):at_least "1 N")"));
  EXPECT_EQ(ran.outcome.code, 1);
  EXPECT_EQ(expectation(ran.run, "thrust")["verdict"], "fail");
  EXPECT_EQ(expectation(ran.run, "second")["verdict"], "pass");
  EXPECT_NE(ran.outcome.out.find("thrust: 2 N, wanted at most 1 N"), std::string::npos);
}

TEST(Program, ResponseTimeCountsFromTheLastBitOfTheCommand) {
  const Ran ran = run_plan(plan_text(R"(
    t:wait "300 ms"
    local step = t:record("thrust", "1 s", function() t:command { thrust = "3.2 N" } end)
    t:expect(step:response_time()):at_most "200 ms"
    t:expect(step:overshoot()):at_most "10 %")"));
  // tau ln 10 after the command was given, which took 0.3 ms to pass the wire.
  EXPECT_TRUE(near(expectation(ran.run, "thrust response time")["measured"],
                   50.0 * std::log(10.0) - 0.3, stated(0.1, "1 ms samples")));
}

TEST(Program, SettlingAfterAGustIsMeasuredOnTheDistance) {
  const Ran ran = run_plan(plan_text(R"(
    t:wait "300 ms"
    local r = t:record({ "east", "height" }, "3 s", function() t:gust { duration = "500 ms" } end)
    t:expect(r:settled("10 cm", { east = "0 m" })):at_most "1 s"
    t:expect(r:max "east"):at_most "20 cm"
    t:expect(r:settled("height", "10 cm", "0 m"), "height stays"):at_most "1 ms"
    t:expect(r:rms_error { east = "0 m", height = "0 m" }):at_most "20 cm")"));
  EXPECT_EQ(ran.outcome.code, 0) << ran.outcome.out;
  // 0.15 m after 500 ms, then back with tau 500 ms: within 0.1 m after 500 ms ln 1.5 more.
  EXPECT_TRUE(near(expectation(ran.run, "east settling time")["measured"],
                   0.5 + 0.5 * std::log(1.5), stated(0.003, "1 ms steps")));
}

TEST(Program, AGuardTellsTheWorstValueOfItsTime) {
  const Ran ran = run_plan(plan_text(R"(
    t:always("height"):at_most "1 m"
    t:always("stays low", function(s) return s.height_m < 0.5 end)
    t:always("east", "100 ms"):at_most "1 mm"
    t:command { takeoff = "1.1 m" }
    t:wait "3 s")"));
  EXPECT_EQ(ran.outcome.code, 1);
  EXPECT_TRUE(near(expectation(ran.run, "height, always")["measured"], 1.1, stated(1e-6, "e^-15")));
  EXPECT_EQ(expectation(ran.run, "east, always")["verdict"], "pass");
  // Above 0.5 m after tau ln(1.1/0.6) = 121 ms: violated for the rest of 3 s.
  EXPECT_TRUE(near(expectation(ran.run, "stays low (time violated)")["measured"],
                   3.0 - 0.2 * std::log(1.1 / 0.6), stated(0.0021, "whole steps, both ends")));
}

TEST(Program, WithinMeasuresHowLongItTook) {
  const Ran ran = run_plan(plan_text(R"(
    t:command { takeoff = "1 m" }
    t:within("1 s", function(s) return s.height_m > 0.5 end, "half way")
    t:within("100 ms", function(s) return s.height_m > 5 end, "to the moon"))"));
  EXPECT_TRUE(near(expectation(ran.run, "half way")["measured"], 0.2 * std::log(2.0),
                   stated(0.0021, "whole steps")));
  EXPECT_EQ(expectation(ran.run, "to the moon")["verdict"], "fail");
  EXPECT_TRUE(expectation(ran.run, "to the moon")["measured"].is_null());
}

TEST(Program, TimingBudgetsBusesAndLatencyAreJudged) {
  const Ran ran = run_plan(plan_text(R"(
    t:wait "100 ms"
    t:budget("fw::imu_task") { period = "1 ms", jitter = "20 us", execution = "50 us", response = "70 us",
                                latency = "7 us" }
    t:budget("cpu") { busy = "60 %" }
    t:bus { device = "esc1", direction = "write", period = "20 ms", tolerance = "0.5 ms" }
    t:bus { device = "esc2", direction = "read", period = "50 ms", tolerance = "1 ms" }
    t:bus { device = "imu", bytes = 15, period = "1 ms", tolerance = "20 us" }
    t:latency { from = "imu", through = { "fw::imu_task", "fw::attitude_task" }, to = "esc", at_most = "7 ms" }
    t:wait "1 s")"));
  EXPECT_EQ(ran.outcome.code, 0) << ran.outcome.out;
  EXPECT_TRUE(near(expectation(ran.run, "fw::imu_task execution time")["measured"], 40.0,
                   stated(1e-6, "exact in the fake")));
  EXPECT_TRUE(near(expectation(ran.run, "fw::imu_task response time")["measured"], 60.0,
                   stated(1e-6, "exact in the fake")));
  EXPECT_TRUE(near(expectation(ran.run, "fw::imu_task interrupt latency")["measured"], 6.0,
                   stated(1e-6, "exact in the fake")));
  EXPECT_TRUE(
      near(expectation(ran.run, "CPU busy share")["measured"], 40.0, stated(1e-9, "exact")));
  // Data ready at 100 us, imu task 140..200, attitude from 300, the second write ends at 770 us.
  EXPECT_TRUE(
      near(expectation(ran.run, "imu to esc latency")["measured"], 0.67, stated(1e-6, "exact")));
}

TEST(Program, ABusThatFallsSilentHasAPeriodTooLong) {
  const Ran ran = run_plan(plan_text(R"(
    t:bus { device = "esc1", direction = "write", period = "20 ms", tolerance = "0.5 ms" }
    t:wait "1 s")",
                                     "asleep"));
  EXPECT_EQ(ran.outcome.code, 1);
  EXPECT_TRUE(near(expectation(ran.run, "esc1 write period deviation")["measured"], 980.0,
                   stated(1e-6, "the whole window")));
  EXPECT_EQ(expectation(ran.run, "esc1 write NACKs")["verdict"], "fail");
}

TEST(Program, AFaultActsAndIsCounted) {
  const Ran ran = run_plan(plan_text(R"(
    t:bus { device = "esc2", direction = "write", nacks = 5 }
    t:fault { kind = "i2c_nack", device = "esc2", start = "100 ms", duration = "100 ms" }
    t:fault { kind = "mocap_lost", duration = "1 s" }
    t:wait "1 s")"));
  EXPECT_EQ(ran.outcome.code, 0) << ran.outcome.out;
  EXPECT_EQ(expectation(ran.run, "esc2 write NACKs")["measured"], 5.0);
  EXPECT_TRUE(near(ran.run["faults"][0]["applied_s"], 0.10069, stated(1e-9, "exact")));
}

TEST(Program, AFaultThatNobodyAppliedIsAnError) {
  const Ran ran = run_plan(plan_text(R"(
    t:fault { kind = "i2c_nack", device = "esc2", start = "10 s" }
    t:expect(t:value "tilt"):at_most "1 rad"
    t:wait "1 s")"));
  EXPECT_EQ(ran.outcome.code, 2);
  EXPECT_NE(ran.outcome.out.find("was applied by nobody"), std::string::npos);
}

TEST(Program, AFirmwareFaultFailsByNameAddressAndFunction) {
  const Ran ran =
      run_plan(plan_text("t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\"", "crash"));
  EXPECT_EQ(ran.outcome.code, 1);
  EXPECT_EQ(ran.run["reason"], "firmware fault: HardFault in fw::crash+0x4 at 0x08001234");
  EXPECT_NE(ran.run["cpu_faults"][0]["registers"].get<std::string>().find("PRECISERR"),
            std::string::npos);
}

TEST(Program, AFirmwareThatSleepsForEverFailsAtTheTimeoutInVirtualTime) {
  const Ran ran = run_plan(plan_text(R"(
    t:step "waiting for the bus"
    while not t:wait_until(function(s) return s.height_m > 1 end, "1 s") do end)",
                                     "asleep"));
  EXPECT_EQ(ran.outcome.code, 1);
  EXPECT_TRUE(near(ran.run["virtual_s"], 5.0, stated(1e-9, "the plan's timeout")));
  EXPECT_NE(ran.run["reason"].get<std::string>().find("waiting for the bus"), std::string::npos);
}

TEST(Program, ATargetThatStopsAnsweringIsAnInternalErrorAndAHostThatIsLateIsInconclusive) {
  const std::string body = "t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\"";
  EXPECT_EQ(run_plan(plan_text(body, "lost")).outcome.code, 4);
  EXPECT_EQ(run_plan(plan_text(body, "late")).outcome.code, 3);
}

struct Bad {
  const char* what;
  std::string text;
  const char* message;
};

TEST(Program, BadPlansAreOneClearLineAndExitCodeTwo) {
  const Bad kBad[] = {
      {"syntax", "plan \"p\" {", "p.lua:1: "},
      {"unit", plan_text("t:wait \"5 furlong\""), "p.lua:3: unknown unit 'furlong'"},
      {"dimension", plan_text("t:wait \"5 N\""), "'5 N' is a force, not a time"},
      {"device", plan_text("t:bus { device = \"esc9\" }"), "unknown device 'esc9'"},
      {"signal", plan_text("t:always(\"heigth\"):at_most \"1 m\""), "unknown signal 'heigth'"},
      {"loop", plan_text("\nwhile true do end"), "p.lua:4: endless loop?"},
      {"loop in a condition", plan_text("t:wait_until(function() while true do end end, \"1 s\")"),
       "endless loop?"},
      {"no image", plan_text("t:wait \"1 s\"", "nowhere"), "'nowhere' is not there"},
      {"nothing expected", plan_text("t:wait \"1 s\""), "expects nothing"},
      {"no limit", plan_text("t:expect(1) t:wait \"1 s\""), "has no limit"},
      {"unknown key", plan_text("", "flight", "colour = 1,"), "unknown key 'colour'"},
      {"unknown command", plan_text("t:command { fly = true }"), "unknown key 'fly'"},
      {"no bus", plan_text("t:fault { kind = \"i2c_nack\", bus = \"i2c99999999999\" }"),
       "is no bus"},
      {"unknown fault", plan_text("t:fault { kind = \"gremlins\" }"),
       "unknown kind of fault 'gremlins'"},
      {"not watched", plan_text("t:budget(\"fw::x\") { execution = \"1 ms\" }"), "is not watched"},
      {"nobody listens", plan_text("t:ask 'x'"),
       "p.lua:3: nobody listens to lines here (t:ask is for stands)"},
      {"no plan", "local x = 1", "declares no plan"},
      {"lua error", plan_text("local x = nil + 1"), "attempt to perform arithmetic"},
  };
  for (const Bad& bad : kBad) {
    const Ran ran = run_plan(bad.text);
    EXPECT_EQ(ran.outcome.code, 2) << bad.what;
    const std::string all = ran.outcome.out + ran.outcome.err;
    EXPECT_NE(all.find(bad.message), std::string::npos) << bad.what << ": " << all;
  }
}

// The fake calls attitude_task from no interrupt.
TEST(Program, WhatNoInterruptCallsHasNoLatencyAndMeetsNoLimit) {
  const Ran ran = run_plan(plan_text(R"(
    t:budget("fw::attitude_task") { latency = "1 s" }
    t:wait "1 s")"));
  EXPECT_EQ(ran.outcome.code, 1) << ran.outcome.out;
  EXPECT_EQ(expectation(ran.run, "fw::attitude_task interrupt latency")["verdict"], "fail");
}

TEST(Program, BadUsageIsExitCodeTwo) {
  const FakeRoot root;
  EXPECT_EQ(whirl(root, {"run", "nowhere.lua"}).code, 2);
  EXPECT_EQ(whirl(root, {"run", "--colour"}).code, 2);
  EXPECT_EQ(whirl(root, {}).code, 2);
  for (const char* seed : {"x", "-1", "18446744073709551616", "", "1.5", " 1"}) {
    EXPECT_EQ(whirl(root, {"run", "--seed", seed}).code, 2) << seed;
  }
  EXPECT_EQ(whirl(root, {"--help"}).code, 0);
  EXPECT_EQ(whirl(root, {"--version"}).code, 0);
}

TEST(Program, TheSamePlanAndSeedGiveTheSameDigestAndTwiceMakesItAVerdict) {
  const std::string body = "t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\"";
  const Ran once = run_plan(plan_text(body)), again = run_plan(plan_text(body));
  EXPECT_EQ(once.run["digest"], again.run["digest"]);
  EXPECT_EQ(run_plan(plan_text(body), {"--twice"}).outcome.code, 0);
  EXPECT_EQ(run_plan(plan_text(body, "drifting"), {"--twice"}).outcome.code, 1);
}

TEST(Program, OfSeveralPlansTheWorstCounts) {
  FakeRoot root;
  const std::string good = "t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\"";
  root.write("test_plans/a.lua", plan_text(good));
  root.write("test_plans/b.lua",
             plan_text("t:wait \"1 s\" t:expect(t:value \"thrust\"):at_most \"1 N\""));
  EXPECT_EQ(whirl(root, {"run"}).code, 1);
  root.write("test_plans/c.lua", "plan");
  EXPECT_EQ(whirl(root, {"run"}).code, 2);
  root.write("test_plans/d.lua", plan_text(good, "lost"));
  EXPECT_EQ(whirl(root, {"run"}).code, 4);
}

std::size_t times(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

// For a server that shows tests: one file of all, with those that never ran.
TEST(Program, OneJunitFileHoldsAllPlansOfACommand) {
  FakeRoot root;
  root.write("test_plans/a.lua",
             plan_text("t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\""));
  root.write("test_plans/b.lua", plan_text("", "no_such_image"));
  root.write("test_plans/c.lua", "plan");
  EXPECT_EQ(whirl(root, {"run"}).code, 2);
  const std::string merged = root.read("results/junit.xml");
  EXPECT_EQ(times(merged, "<testsuite "), 3u) << merged;
  EXPECT_EQ(times(merged, "<error "), 2u) << merged;
  EXPECT_NE(merged.find("'no_such_image' is not there"), std::string::npos) << merged;
}

TEST(Program, ARunThatIsRefusedLeavesItsFolder) {
  FakeRoot root;
  root.write("test_plans/b.lua", plan_text("", "no_such_image"));
  const Outcome outcome = whirl(root, {"run"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.out.find("index.html"), std::string::npos) << outcome.out;
  for (const char* file : {"run.json", "junit.xml", "index.html"}) {
    EXPECT_NE(root.read(std::string("results/runs/latest/") + file).find("'no_such_image'"),
              std::string::npos)
        << file;
  }
  EXPECT_EQ(root.read("results/runs/latest/truth.csv"), "");
}

// What a campaign varies, without a file of its own for each case.
TEST(Program, ASettingTakesThePlaceOfWhatThePlanSays) {
  FakeRoot root;
  root.write("test_plans/p.lua",
             plan_text("t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\""));
  EXPECT_EQ(whirl(root, {"run"}).code, 0);
  EXPECT_EQ(whirl(root, {"run", "--set", "plan.timeout=500 ms"}).code, 1);
  const json run = parse_json(root.read("results/runs/latest/run.json"));
  EXPECT_EQ(run["versions"]["set plan.timeout"], "500 ms");
  for (const std::string key : {"plan.image", "plan.board", "plan.vehicle"}) {
    const Outcome missing = whirl(root, {"run", "--set", key + "=nowhere"});
    EXPECT_EQ(missing.code, 2);
    EXPECT_NE(missing.out.find("the command line's " + key + ": 'nowhere' is not there"),
              std::string::npos)
        << missing.out;
  }
  const Outcome unknown = whirl(root, {"run", "--set", "plan.timeuot=1 s"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("unknown key 'timeuot'"), std::string::npos) << unknown.err;
  for (const char* wrong : {"timeout=1 s", "plan.timeout", "plan.=1", "board.hse=1 Hz"}) {
    EXPECT_EQ(whirl(root, {"run", "--set", wrong}).code, 2) << wrong;
  }
}

// Before it starts, and at the line; what only the run shows is refused when it comes.
TEST(Program, AnAskThatTheTargetDoesNotOfferIsRefused) {
  FakeRoot root;
  root.write("build/firmware/modest.elf", "x");
  root.write("test_plans/p.lua", plan_text("-- no t:budget('x') { }\nt:wait '10 ms'\n"
                                           "t:budget('cpu') { busy = '60 %' }",
                                           "modest"));
  Outcome outcome = whirl(root, {"run"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.out.find("p.lua:5: t:budget asks for watches"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(root.read("results/runs/latest/truth.csv"), "");  // it never started
  root.write("test_plans/p.lua", plan_text("t:wait '10 ms' local b = t.budget\n"
                                           "b(t, 'cpu') { busy = '60 %' }",
                                           "modest"));
  outcome = whirl(root, {"run"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.out.find("p.lua:4: t:budget asks for watches"), std::string::npos)
      << outcome.out;
  EXPECT_NE(root.read("results/runs/latest/truth.csv"), "");
  root.write("test_plans/p.lua",
             plan_text("t:fault { kind = 'i2c_nack', bus = 'i2c3' }", "modest"));
  outcome = whirl(root, {"run"});
  EXPECT_NE(outcome.out.find("p.lua:3: a fault of kind i2c_nack asks for faults"),
            std::string::npos)
      << outcome.out;
}

TEST(Program, TagsChooseAndListShows) {
  FakeRoot root;
  root.write("test_plans/a.lua",
             plan_text("t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\"", "flight",
                       "tags = { \"quick\" },"));
  root.write("test_plans/b.lua", plan_text("t:expect(t:value \"thrust\"):at_most \"1 N\""));
  EXPECT_EQ(whirl(root, {"run", "--tag", "quick"}).code, 0);
  EXPECT_EQ(whirl(root, {"run", "--tag", "slow"}).code, 2);
  EXPECT_NE(whirl(root, {"list"}).out.find("[quick]"), std::string::npos);
}

TEST(Program, DevicesPrintsEveryTypeWithItsKeys) {
  const FakeRoot root;
  const auto printed = whirl(root, {"devices"});
  EXPECT_EQ(printed.code, 0);
  EXPECT_NE(printed.out.find("| **mpu6000** "), std::string::npos) << printed.out;
  EXPECT_NE(printed.out.find("| `params.shunt.gain_error` "), std::string::npos);
}

TEST(Program, JsonOnStandardOutputIsTheRunsOwnFile) {
  FakeRoot root;
  root.write("test_plans/p.lua",
             plan_text("t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\""));
  const Outcome outcome = whirl(root, {"run", "--json"});
  EXPECT_EQ(parse_json(outcome.out), parse_json(root.read("results/runs/latest/run.json")));
}

TEST(Program, HistoryRemembersTheMargins) {
  FakeRoot root;
  root.write(
      "test_plans/p.lua",
      plan_text("t:wait \"1 s\" t:expect(t:value(\"thrust\", \"N\") - 0.5, \"x\"):at_most(2)"));
  EXPECT_EQ(whirl(root, {"history"}).code, 2);
  whirl(root, {"run"});
  whirl(root, {"run"});
  const Outcome outcome = whirl(root, {"history", "p"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("p: x\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("margin 0.5"), std::string::npos) << outcome.out;
  const Outcome none = whirl(root, {"history", "q"});
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("holds no run of 'q'"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace whirl::test

// Verdicts as a user meets them: who is at fault, what was not shown, and what a run leaves behind that
// did not end well.
#include <sys/stat.h>

#include <filesystem>

#include "base/interruption.hpp"
#include "base/json_text.hpp"
#include "base/near.hpp"
#include "harness/tests/plans.hpp"

namespace whirl::test {
namespace {

// A plan's exit code and what it says.
struct Case {
  const char* body;
  const char* image;
  int code;
  const char* says;
};

void check(std::initializer_list<Case> cases) {
  for (const Case& c : cases) {
    const Ran ran = run_plan(plan_text(c.body, c.image));
    EXPECT_EQ(ran.outcome.code, c.code) << c.body << "\n" << ran.outcome.out << ran.outcome.err;
    EXPECT_NE((ran.outcome.out + ran.outcome.err).find(c.says), std::string::npos)
        << c.body << "\n"
        << ran.outcome.out;
  }
}

TEST(Verdict, WhatWasSeenOfTheFirmwareIsNotBlamedOnThePlan) {
  check({
      // The fault is due after the crash at 50 ms: nobody can have applied it.
      {R"(t:fault { kind = "i2c_nack", device = "esc1", start = "500 ms" }  t:wait "1 s")", "crash",
       1, "HardFault"},
      {R"(t:expect(t:value "tilt")  t:wait "1 s")", "crash", 1, "HardFault"},
      {R"(t:expect(t:value "thrust"):at_most "1 N"  error "then the plan breaks")", "flight", 1,
       "also: p.lua:3: then the plan breaks"},
      {R"(t:expect(t:value "thrust"):at_most "1 N"  t:wait "1 s")", "lost", 1,
       "also: board: no answer"},
      {R"(t:expect(t:value "thrust"):at_most "1 N"  t:wait "1 s")", "late", 1,
       "also: host: too late"},
      // And the host's fault is not the plan's.
      {R"(t:fault { kind = "i2c_nack", device = "esc1", start = "500 ms" }  t:wait "1 s")", "late",
       3, "too late"},
      {R"(t:always "height"  t:wait "1 s")", "late", 3, "too late"},
  });
}

TEST(Verdict, AWatchdogsResetFailsByItsNameAndTime) {
  const std::string body = R"(t:expect(t:value "tilt"):at_most "1 rad"  t:wait "1 s")";
  const Ran ran = run_plan(plan_text(body, "bitten"));
  EXPECT_EQ(ran.outcome.code, 1);
  EXPECT_EQ(ran.run["reason"], "firmware fault: reset by the window watchdog");
  const json& fed = expectation(ran.run, "the firmware keeps its watchdogs fed");
  EXPECT_TRUE(near(fed["t_s"], 0.051, stated(1e-9, "the end of the step")));
  EXPECT_TRUE(near(ran.run["virtual_s"], 0.051, stated(1e-9, "the end of the step")));
  EXPECT_EQ(run_plan(plan_text(body, "bitten", "may_reset = true,")).outcome.code, 0);
}

TEST(Verdict, WhatWasNotShownIsNoPass) {
  check({
      {R"(t:always("always true", function() return true end))", "flight", 3,
       "was never watched: its time is empty"},
      {R"(t:always("never true", function() return false end))", "flight", 1,
       "first violated at 0.000000 s"},
      {R"(t:always("height", "1 s"):at_most "1 m")", "flight", 3, "never watched"},
      {R"(t:always("height"):at_most "1 m")", "flight", 3, "never watched"},
      {R"(t:always("height", "1 s"):at_most "1 m"  t:wait "100 ms")", "flight", 3,
       "only 100 ms of 1000 ms were watched"},
      {R"(t:always("low", function(s) return s.height_m < 9 end, "1 s")  t:wait "100 ms")",
       "flight", 3, "only 100 ms of 1000 ms"},
      {R"(t:budget("fw::imu_task") { execution = "1 ms", during = "100 s" }  t:wait "100 ms")",
       "flight", 3, "only 100 ms of 100000 ms"},
      {R"(t:budget("cpu") { busy = "60 %", during = "100 s" }  t:wait "500 ms")", "flight", 3,
       "only 500 ms"},
      {R"(t:budget("fw::imu_task") { share = "99 %", during = "100 s" }  t:wait "100 ms")",
       "flight", 3, "only 100 ms of 100000 ms"},
      {R"(t:bus { device = "esc1", nacks = 3, during = "9 s" }  t:wait "100 ms")", "flight", 3,
       "only 100 ms"},
      // What was seen to be broken is a fail, however short the time.
      {R"(t:budget("fw::imu_task") { execution = "1 us", during = "100 s" }  t:wait "100 ms")",
       "flight", 1, "execution time"},
      {R"(t:budget("fw::imu_task") { share = "0.0001 %", during = "100 ms" }  t:wait "200 ms")",
       "flight", 1, "share of time"},
      {R"(t:always("thrust", "1 s"):at_most "1 N"  t:wait "100 ms")", "flight", 1,
       "thrust, always"},
      // The last step of a window belongs to it.
      {R"(t:always("thrust", "1 s"):at_most "3 N"  t:wait "1 s")", "flight", 0, "PASS"},
      {R"(t:always("low", function(s) return s.height_m < 9 end, "1 ms")  t:wait "1 ms")", "flight",
       0, "PASS"},
      // Nothing of a running image is asserted.
      {R"(t:wait "1 s"  t:expect(1):at_most(2))", "flight", 3,
       "asserts nothing about the running image"},
      {R"(t:wait "1 s"  t:expect(t:value "tilt"):at_most "1 rad")", "asleep", 3,
       "never seen to run"},
      {R"(t:expect(-1/0):at_most(5)  t:wait "1 s")", "flight", 1, "-inf"},
  });
}

// A window without samples, a record without rows, a change that did not come, a limit that is none.
TEST(Verdict, AnExpectationWithoutAFigureIsNoPass) {
  const std::string after_second = "t:wait \"1 s\" ";
  for (const char* measured :
       {"0/0", "1/0", R"(t:record("thrust", "1 s"):rise_time())",
        R"(t:record("thrust", "1 s"):fall_time())", R"(t:record("thrust", "1 s"):response_time())",
        R"(t:record("thrust", "1 s"):overshoot())", R"(t:record("thrust", "1 s"):settled("5 %"))",
        R"(t:record("thrust", "150 ms"):final())"}) {
    const std::string expect = after_second + "local x = " + measured + " t:expect(x)";
    const bool number = measured[1] == '/';
    const bool force = expect.find("final") != std::string::npos;
    const bool ratio = expect.find("overshoot") != std::string::npos;
    const char* limit = number ? "(1e9)" : force ? " '99 N'" : ratio ? " '99 %'" : " '99 s'";
    const Ran ran = run_plan(plan_text(expect + ":at_most" + limit));
    EXPECT_EQ(ran.outcome.code, 1) << measured << ran.outcome.out << ran.outcome.err;
  }
  check({
      {R"(t:within("20 ms", function(s) return s.height_m > 9 end, "high"))", "flight", 1,
       "never came true"},
      // Nobody calls, nobody speaks.
      {R"(t:budget("fw::imu_task") { execution = "1 s" }  t:wait "1 s")", "asleep", 1,
       "nothing to measure"},
      {R"(t:budget("fw::imu_task") { response = "1 s" }  t:wait "1 s")", "asleep", 1,
       "nothing to measure"},
      {R"(t:budget("fw::imu_task") { latency = "1 s" }  t:wait "1 s")", "asleep", 1,
       "nothing to measure"},
      {R"(t:budget("fw::imu_task") { period = "2 s", jitter = "1 s" }  t:wait "1 s")", "asleep", 1,
       "nothing to measure"},
      {R"(t:budget("cpu") { busy = "99 %" }  t:wait "1 s")", "asleep", 1, "nothing to measure"},
      {R"(t:budget("fw::imu_task") { share = "99 %" }  t:wait "1 s")", "asleep", 1,
       "share of time: nothing"},
      {R"(t:budget("fw::imu_task") { rate = "99 %", of = "imu" }  t:wait "1 s")", "asleep", 1,
       "rate error: nothing"},
      {R"(t:budget("fw::imu_task") { rate = "1 %", of = "nobody" }  t:wait "1 s")", "flight", 2,
       "no device of"},
      {R"(t:bus { device = "esc1", nacks = 99 }  t:wait "1 s")", "asleep", 1, "0 transactions"},
      {R"(t:latency { from = "imu", through = { "fw::imu_task" }, to = "esc", at_most = "9 s" }
          t:wait "1 s")",
       "asleep", 1, "nothing to measure"},
      // SPI has no NACK that could be counted.
      {R"(t:bus { device = "imu" }  t:wait "1 s")", "flight", 2, "a window of nothing"},
      {R"(t:expect(t:value "tilt"):at_most "inf rad"  t:wait "1 s")", "flight", 2, "inf"},
      {R"(t:wait "1 s"  t:expect(t:value("tilt", "rad")):at_most(1/0))", "flight", 2,
       "a limit is a finite number"},
      {R"(t:wait "1 s"  t:expect(t:value("tilt", "rad")):within(0, 1/0))", "flight", 2,
       "a limit is a finite number"},
      {R"(t:wait "1 s"  t:expect(t:value("tilt", "rad")):at_least(-1/0))", "flight", 2,
       "a limit is a finite number"},
      {R"(t:wait "1 s"  t:expect(t:value("tilt", "rad")):equal(0/0))", "flight", 2,
       "a limit is a finite number"},
  });
}

TEST(Verdict, ATimeThatLiesOnItsLimitMeetsIt) {
  check(
      {{R"(t:within("60 ms", function() return t:value("tilt", "rad") > 0 and t:now().value > 0.0595 end)
            t:wait "10 ms")",
        "flight", 0, "PASS"}});
}

TEST(Plan, WhatIsDrawnLiesBetweenItsEndsAndComesFromTheSeed) {
  const std::string text = plan_text(R"(t:expect(t:value "tilt"):at_most "3 rad"
    t:wait(t:drawn("1 s", "2 s"))
    t:expect(t:now(), "one"):within("1 s", "2 s")
    t:wait(t:drawn("500 ms", "600 ms"))
    t:expect(t:now(), "two"):at_least "1.5 s")");
  const auto times = [&](const char* seed) {
    const Ran ran = run_plan(text, {"--seed", seed});
    EXPECT_EQ(ran.outcome.code, 0) << ran.outcome.err;
    return std::pair{expectation(ran.run, "one")["measured"].get<double>(),
                     expectation(ran.run, "two")["measured"].get<double>()};
  };
  const auto first = times("1");
  EXPECT_EQ(times("1"), first);
  EXPECT_NE(times("2").first, first.first);
  EXPECT_NE(first.second - first.first - 0.5, first.first - 1.0);
  check({{R"(t:drawn("2 s", "1 s"))", "flight", 2, "the lower end comes first"}});
}

TEST(Plan, ACommandThatIsStillToComeAtTheEndIsAnError) {
  check({{R"(t:at("3 s", { land = true })  t:wait "1 s"  t:expect(t:value "tilt"):at_most "3 rad")",
          "flight", 2, "1 commands were still to come"}});
}

TEST(Plan, WordsThatNobodyTellsFailAndNoneAreRefused) {
  check({{R"(t:told("200 ms", "battery low"))", "flight", 1, "told 'battery low'"},
         {R"(t:told("200 ms", ""))", "flight", 2, "t:told: no words"},
         {R"(t:told("200 ms"))", "flight", 2, "words"}});
}

TEST(Verdict, AThrownErrorEndsOnePlanAndTheNextStillRuns) {
  FakeRoot root;
  const std::string good = "t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\"";
  root.write("test_plans/a.lua", plan_text(good, "throws"));
  root.write("test_plans/b.lua", plan_text(good));
  const Outcome outcome = whirl(root, {"run"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.out.find("1 passed, 1 internal errors"), std::string::npos) << outcome.out;
  const std::string failed = "t:expect(t:value \"thrust\"):at_most \"1 N\" t:wait \"1 s\"";
  EXPECT_EQ(run_plan(plan_text(failed, "throws")).outcome.code, 1);
}

TEST(Verdict, AnInterruptedRunEndsInOrder) {
  FakeRoot root;
  const std::string good = "t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\"";
  root.write("test_plans/a.lua", plan_text(good, "interrupted"));
  root.write("test_plans/b.lua", plan_text(good));
  const Outcome outcome = whirl(root, {"run"});
  pretend_interruption(0);
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.out.find("interrupted by signal TERM"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("0 passed, 1 inconclusive, 1 not run"), std::string::npos);
  EXPECT_NE(outcome.out.find("-p-interrupted/index.html"), std::string::npos);
  const json run = parse_json(root.read("results/runs/latest/run.json"));
  EXPECT_EQ(run["verdict"], "inconclusive");
  EXPECT_TRUE(near(run["virtual_s"], 0.051, stated(1e-9, "at once")));
  EXPECT_EQ(whirl(root, {"history", "p"}).code, 0);
}

TEST(Verdict, ResultsThatCannotBeWrittenDoNotHideAFailure) {
  FakeRoot root;
  root.write("test_plans/p.lua",
             plan_text("t:expect(t:value \"thrust\"):at_most \"1 N\" t:wait \"1 s\""));
  root.write("in_the_way/runs", "");
  const Outcome before = whirl(root, {"run", "--out", root.path() + "/in_the_way"});
  EXPECT_EQ(before.code, 3);  // known before the run
  EXPECT_NE(before.out.find("no folder for the results"), std::string::npos) << before.out;
  root.write("taken/history.sqlite/x", "");
  const Outcome after = whirl(root, {"run", "--out", root.path() + "/taken"});
  EXPECT_EQ(after.code, 1);
  EXPECT_NE(after.out.find("thrust: 2 N, wanted at most 1 N"), std::string::npos);
}

TEST(Verdict, FoldersThatCannotBeReadAreNotSkipped) {
  FakeRoot root;
  root.write("test_plans/a.lua",
             plan_text("t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\""));
  std::filesystem::create_directory_symlink(root.path() + "/nowhere",
                                            root.path() + "/test_plans/b.lua");
  EXPECT_EQ(whirl(root, {"run"}).code, 2);
  std::filesystem::remove(root.path() + "/test_plans/b.lua");
  std::filesystem::create_directory_symlink(root.path() + "/test_plans",
                                            root.path() + "/test_plans/again");
  EXPECT_EQ(whirl(root, {"run"}).code, 0);  // each folder once
  ASSERT_EQ(mkfifo((root.path() + "/test_plans/x.lua").c_str(), 0600), 0);
  const Outcome fifo = whirl(root, {"run"});
  EXPECT_EQ(fifo.code, 2);
  EXPECT_NE(fifo.err.find("no regular file"), std::string::npos) << fifo.err;
  EXPECT_EQ(whirl(root, {"run", "/dev/zero"}).code, 2);
  EXPECT_EQ(whirl(root, {"run", std::string(5000, 'x')}).code, 2);
}

}  // namespace
}  // namespace whirl::test

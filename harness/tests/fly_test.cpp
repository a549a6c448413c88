// whirl fly, and the commands of plans that it needs, against the fakes.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "harness/tests/plans.hpp"

namespace whirl::test {
namespace {

Ran fly(const FakeRoot& root, std::vector<std::string> more = {}) {
  std::vector<std::string> words{"fly",       root.path() + "/test_plans/p.lua",
                                 "--pace",    "1000",
                                 "--udp",     "127.0.0.1:9",
                                 "--seconds", "0.5"};
  words.insert(words.end(), more.begin(), more.end());
  Ran ran{whirl(root, words), nullptr};
  const std::string file = root.read("results/runs/latest/run.json");
  if (!file.empty()) ran.run = parse_json(file);
  return ran;
}

TEST(Fly, GivesNoVerdictWhateverThePlanExpects) {
  for (const char* body : {"t:expect(t:value 'thrust'):at_most '1 N'", "t:wait '300 ms'",
                           "t:always('thrust'):at_most '1 N' t:wait '10 s'"}) {
    FakeRoot root;
    root.write("test_plans/p.lua", plan_text(body));
    const Ran ran = fly(root);
    EXPECT_EQ(ran.outcome.code, 0) << ran.outcome.out << ran.outcome.err;
    EXPECT_EQ(ran.run["verdict"], "none") << body;
    EXPECT_EQ(ran.run["virtual_s"], 0.5) << body;  // its own time, not the script's
    EXPECT_EQ(ran.run["reasons"].size(), 0u);
    EXPECT_NE(ran.outcome.out.find("FLOWN p"), std::string::npos) << ran.outcome.out;
    const std::string junit = root.read("results/runs/latest/junit.xml");
    EXPECT_NE(junit.find("failures=\"0\" errors=\"0\""), std::string::npos) << junit;
  }
}

TEST(Fly, AFaultOfTheFirmwareStaysAFail) {
  FakeRoot root;
  root.write("test_plans/p.lua", plan_text("t:wait '1 s'", "crash"));
  const Ran ran = fly(root);
  EXPECT_EQ(ran.outcome.code, 1);
  EXPECT_EQ(ran.run["verdict"], "fail");
}

TEST(Fly, TheRecordedPlanFliesTheSameFlightAgain) {
  FakeRoot root;
  root.write("test_plans/p.lua", plan_text("t:command { takeoff = '1.1 m' }"));
  const Ran flown = fly(root, {"--seed", "5"});
  const std::string folder =
      std::filesystem::canonical(root.path() + "/results/runs/latest").string();
  const Outcome again = whirl(root, {"run", folder + "/commands.lua", "--json"});
  EXPECT_EQ(again.code, 0) << again.out << again.err;
  const json run = parse_json(again.out);
  EXPECT_EQ(run["digest"], flown.run["digest"]);
  EXPECT_EQ(run["seed"], 5);
  // Another flight ends elsewhere, and the recorded plan says so.
  std::ofstream(folder + "/flown_plan_1.lua") << plan_text("t:command { takeoff = '1.2 m' }");
  EXPECT_EQ(whirl(root, {"run", folder + "/commands.lua"}).code, 1);
}

TEST(Fly, WrongWordsAreBadInput) {
  FakeRoot root;
  root.write("test_plans/p.lua", plan_text("t:wait '1 s'"));
  root.write("test_plans/two.lua", plan_text("t:wait '1 s'") +
                                       "plan 'q' { image = 'flight', vehicle = "
                                       "'hp_quad', run = function() end }");
  root.write("test_plans/stand.lua",
             "plan 's' { image = 'esc', stand = { prop = 'x' }, run = function() end }");
  EXPECT_NE(whirl(root, {"fly", root.path() + "/test_plans/stand.lua"}).err.find("has a stand"),
            std::string::npos);
  EXPECT_EQ(fly(root, {"--pace", "0"}).outcome.code, 2);
  EXPECT_EQ(fly(root, {"--seconds", "-1"}).outcome.code, 2);
  EXPECT_EQ(fly(root, {"--vehicle", "nobody"}).outcome.code, 2);
  EXPECT_EQ(whirl(root, {"fly", root.path() + "/test_plans/p.lua", "--udp", "nowhere"}).code, 2);
  EXPECT_EQ(whirl(root, {"fly", root.path() + "/test_plans/two.lua"}).code, 2);
  EXPECT_EQ(whirl(root, {"fly", root.path() + "/test_plans/none.lua"}).code, 2);
}

// ---- t:at and what it gives

TEST(At, GivesItsCommandAtItsTimeAndThePlanDoesNotWait) {
  const Ran ran = run_plan(plan_text(R"(
    t:at("700 ms", { thrust = "4 N" })
    t:at("300 ms", { thrust = "3 N" })
    t:wait "299 ms"
    local before = t:value("thrust", "N")
    local r = t:record("thrust", "400 ms")
    t:wait "400 ms"
    t:expect(before, "before"):within(1.99, 2.01)
    t:expect(r:final(), "between"):within("2.99 N", "3.01 N")
    t:expect(t:value "thrust", "after"):within("3.9 N", "4 N"))"));
  EXPECT_EQ(ran.outcome.code, 0) << ran.outcome.out << ran.outcome.err;
}

TEST(At, RefusesTimesThatHavePassedAndCommandsThatAreNone) {
  const struct {
    const char *body, *words;
  } kWrong[] = {{"t:wait '5 ms' t:at('4 ms', { takeoff = '1 m' })", "that time has passed"},
                {"t:at('4 m', { takeoff = '1 m' })", "is a length, not a time"},
                {"t:at('4 ms', { takeoff = '-1 m' })", "takeoff"},
                {"t:at('4 ms', { jump = '1 m' })", "jump"},
                {"t:at('4 ms')", "a table { ... } is wanted"},
                {"t:at('4 ms', { land = true }) t:wait '1 s'", "means nothing to a fake"},
                {"t:command { radio = 'fd0' }", "two hexadecimal digits"},
                {"t:command { radio = 'fg' }", "two hexadecimal digits"},
                {"t:command { radio = '' }", "1 to 280 bytes"},
                {"t:command { teleoperation = { script = {} } }", "is empty"},
                {"t:command { teleoperation = { script = { { at = '1 s' }, { at = '1 s' } } } }",
                 "is not later than the one before"},
                {"t:command { waypoints = 'nowhere.txt' }", "cannot be read"},
                {"t:command { waypoints = '../../../etc/hostname' }", "only files below"},
                {"t:command { waypoints = 'p.lua' }", "p.lua:1: x: 'plan' is no number"}};
  for (const auto& wrong : kWrong) {
    const Ran ran = run_plan(plan_text(wrong.body));
    EXPECT_EQ(ran.outcome.code, 2) << wrong.body;
    EXPECT_NE(ran.outcome.out.find(wrong.words), std::string::npos) << wrong.body << "\n"
                                                                    << ran.outcome.out;
  }
}

}  // namespace
}  // namespace whirl::test

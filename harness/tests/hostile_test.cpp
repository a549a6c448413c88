// Plans and options that try to hang, flood or fool the program: each is bounded, and told by name.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "base/json_text.hpp"
#include "harness/tests/fake.hpp"

namespace whirl::test {
namespace {

using nlohmann::json;

Outcome run_file(const FakeRoot& root, const std::string& text) {
  root.write("test_plans/p.lua", text);
  return whirl(root, {"run", root.path() + "/test_plans/p.lua"});
}

Outcome run_body(const FakeRoot& root, const std::string& body) {
  return run_file(root,
                  "plan \"p\" { image = \"flight\", vehicle = \"hp_quad\", timeout = \"5 s\", "
                  "run = function(t)\n" +
                      body + "\nend }\n");
}

json results_of(const FakeRoot& root) {
  return parse_json(root.read("results/runs/latest/run.json"));
}

struct Refused {
  std::string body, words;
};

void expect_refusals(const std::vector<Refused>& cases) {
  for (const Refused& c : cases) {
    const FakeRoot root;
    const Outcome outcome = run_body(root, c.body);
    EXPECT_EQ(outcome.code, 2) << c.body << "\n" << outcome.out << outcome.err;
    EXPECT_NE((outcome.out + outcome.err).find(c.words), std::string::npos)
        << c.body << "\n"
        << outcome.out << outcome.err;
  }
}

TEST(HostilePlan, NothingOutlivesTheInstructionBudget) {
  expect_refusals({
      {"string.find(('a'):rep(1e5), ('.-'):rep(50) .. 'b')", "p.lua:2: endless loop?"},
      {"t:wait_until(function() return ('a'):rep(3e5):gsub('.-b', 'x') end, '1 s')",
       "p.lua:2: endless loop?"},
      {"table.move({}, 1, math.maxinteger - 1, 2)", "p.lua:2: endless loop?"},
      {"local r = t:record('height', '2 s') while true do r:mean() end", "p.lua:2: endless loop?"},
      {"local x = {} for i = 1, 100 do x[i] = i end while true do pcall(t.command, t, x) end",
       "p.lua:2: endless loop?"},
  });
}

TEST(HostilePlan, TablesAreReadUpToABound) {
  expect_refusals({
      {"local x = {} for i = 1, 30 do x = { x, x } end t:command(x)", "more than 100000 values"},
      {"local x = {} x.x = x t:command(x)", "nested too deep"},
  });
}

TEST(HostilePlan, LackOfMemoryIsTheUsersErrorAnywhere) {
  expect_refusals({
      {"local x = {} for i = 1, 1e9 do x[i] = { i } end", "not enough memory: a plan has 256 MiB"},
      {"local x = {} t:wait_until(function() for i = 1, 1e9 do x[#x + 1] = { i } end end, '1 s')",
       "not enough memory"},
  });
  const FakeRoot root;  // all but a rest is used before the run begins
  const Outcome outcome = run_file(
      root,
      "local x = {} local ok = pcall(function() for i = 1, 1e9 do x[i] = { i } end end)\n"
      "plan \"p\" { image = \"flight\", vehicle = \"hp_quad\", run = function(t) t:wait '1 s' end, "
      "keep = x and nil }\n");
  EXPECT_EQ(outcome.code, 2) << outcome.out << outcome.err;
}

TEST(HostilePlan, AnErrorThatIsNoTextReadsTheSameEachTime) {
  expect_refusals({
      {"error({})", "error was called with a table, not with a text"},
      {"t:wait_until(function() error({}) end, '1 s')", "error was called with a table"},
      {"error(t:now())", "error was called with a table"},
  });
}

TEST(HostilePlan, NamesStandInOneLineAndAreNotEmpty) {
  for (const auto& [name, words] : std::vector<std::pair<std::string, std::string>>{
           {"", "its name is empty"},
           {"x\\nPASS  y", "control characters"},
           {"x\\27[2J", "control characters"},
           {"a\\0b", "control characters"},
           {"\\xFF", "no UTF-8"},
           {std::string(300, 'x'), "longer than 200 bytes"}}) {
    const FakeRoot root;
    const Outcome outcome = run_file(
        root, "plan \"" + name + "\" { image = \"flight\", vehicle = \"hp_quad\", run = print }");
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }
}

TEST(HostilePlan, TwoPlansOfOneFileHaveTwoNames) {
  const FakeRoot root;
  const std::string plan =
      "plan \"p\" { image = \"flight\", vehicle = \"hp_quad\", run = function(t) end }\n";
  EXPECT_NE(run_file(root, plan + plan).err.find("two plans are called \"p\""), std::string::npos);
}

TEST(HostilePlan, NamesOfExpectationsForgeNoLine) {
  const FakeRoot root;
  const Outcome outcome = run_body(
      root,
      "t:wait '10 ms' t:expect(3, 'x\\nPASS  other\\27[2J'):at_most(2) error 'no\\nPASS  more'");
  EXPECT_EQ(outcome.out.find("\nPASS"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find('\x1B'), std::string::npos) << outcome.out;
}

// With a search through all names for each new one, this took minutes.
TEST(HostilePlan, TwentyThousandExpectationsOfOneNameAreQuick) {
  const FakeRoot root;
  const Outcome outcome = run_body(root,
                                   "t:wait '10 ms' t:value 'tilt' t:expect(1, 'x (2)'):at_most(2) "
                                   "for i = 1, 20000 do t:expect(1, 'x'):at_most(2) end");
  EXPECT_EQ(outcome.code, 0) << outcome.out;
  const json run = results_of(root);
  std::set<std::string> names;
  for (const json& e : run["expectations"]) names.insert(e["name"]);
  EXPECT_EQ(names.size(), 20001u);
  EXPECT_EQ(run["expectations"][2]["name"], "x (3)");  // (2) is the plan's own
}

TEST(HostilePlan, AFloodOfLogLinesIsCutWithAWord) {
  const FakeRoot root;
  const Outcome outcome = run_body(
      root,
      "t:wait '10 ms' t:expect(t:value 'tilt'):at_most '1 rad' local line = ('y'):rep(1000000) "
      "for i = 1, 50 do t:log(line) end for i = 1, 6000 do t:log(i) end");
  EXPECT_EQ(outcome.code, 0) << outcome.out;
  const json log = results_of(root)["log"];
  ASSERT_EQ(log.size(), 5001u);
  EXPECT_EQ(log[0]["text"], std::string(2000, 'y') + " ... (998000 bytes more)");
  EXPECT_EQ(log[5000]["text"], "the log is full: what follows is left out");
  EXPECT_LT(root.read("results/runs/latest/index.html").size(), 2'000'000u);
}

TEST(HostilePlan, CountsOfWhatIsAskedForAreBounded) {
  expect_refusals({
      {"for i = 1, 2000 do t:always('height'):at_most '1 m' end", "more than 1000 guards"},
      {"for i = 1, 2000 do t:budget('fw::imu_task') { execution = '1 s' } end",
       "more than 1000 budgets"},
      {"for i = 1, 2e5 do t:expect(1) end", "more than 100000 expectations"},
      {"t:step(('x'):rep(5000))", "a step's name of 5000 bytes"},
      {"t:wait '9e9 s'", "is too long a time"},
      {"t:always('height', '1e308 min')", "is too large"},
  });
}

TEST(HostileOptions, SweepsEnd) {
  const FakeRoot root;
  for (const auto& [option, value] :
       std::vector<std::pair<std::string, std::string>>{{"--voltage", "1e9 V"},
                                                        {"--voltage", "0 V"},
                                                        {"--speed", "1e9 rpm"},
                                                        {"--speed", "-1 rpm"},
                                                        {"--top-speed", "1e300 rpm"},
                                                        {"--top-speed", "0 rpm"}}) {
    const Outcome outcome = whirl(root, {"sweep", "nowhere.lua", option, value});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find(option + ": '" + value + "' is outside"), std::string::npos)
        << outcome.err;
  }
}

TEST(HostileOptions, SweepsOfCopiesRefuseWhatTheyCannotDraw) {
  FakeRoot root;
  root.write("neither.lua", "return { kind = \"boat\" }");
  root.write("motor.lua",
             "return { kind = 'motor', name = 'm', kv_rpm_per_V = 950, resistance = '120 mohm', "
             "no_load_current = '1 A', inertia = '4e-5 kg m2', pole_pairs = 7 }");
  const std::string motor = root.path() + "/motor.lua";
  const auto swept = [&](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> words{"sweep", file};
    words.insert(words.end(), more.begin(), more.end());
    return whirl(root, words);
  };
  EXPECT_EQ(swept(motor, {"--seeds", "1..3"}).code, 0);
  EXPECT_NE(swept(root.path() + "/neither.lua", {"--seeds", "1..3"}).err.find("is no propeller"),
            std::string::npos);
  for (const std::vector<std::string>& bad : {std::vector<std::string>{"--seeds", "x"},
                                              {"--seeds", "4..2"},
                                              {"--seeds", ""},
                                              {"--tolerance", "worst"},
                                              {"--seeds", "1..3", "--tolerance", "none"},
                                              {"--seeds", "1..3", "--voltage", "5 V"},
                                              {"--seeds", "1..3", "--measured", motor}}) {
    EXPECT_EQ(swept(motor, bad).code, 2) << bad.back();
  }
}

TEST(HostileResults, ADamagedHistoryIsNoBadUsage) {
  const FakeRoot root;
  root.write("results/history.sqlite", std::string(5000, 'x'));
  EXPECT_EQ(whirl(root, {"history"}).code, 3);
}

}  // namespace
}  // namespace whirl::test

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "base/json_text.hpp"
#include "base/output_file.hpp"
#include "base/scratch_folder.hpp"
#include "base/text.hpp"
#include "results/charts.hpp"
#include "results/folder.hpp"
#include "results/tests/sample.hpp"

namespace whirl::results {
namespace {

namespace fs = std::filesystem;

std::string contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

const std::vector<Column> kColumns = {
    {"height", "m", "m"}, {"climb", "mps", "m/s"}, {"armed", "", ""}};

Curves curves() {
  Curves drawn(kColumns, 1'000'000, 5000);
  for (int i = 0; i < 5000; ++i) {
    const double row[] = {i == 2500 ? 9.0 : 1.0, std::nan(""), 1.0};
    drawn.on_row(i * 1'000'000LL, row);
  }
  return drawn;
}

MessageWriter messages_of(const RunFolder& folder) {
  MessageWriter out(folder.messages(), {"p", 1, 1'000'000, kColumns, {{"", {}, {}, {}}}});
  const double row[] = {1.0, 2.0, 3.0};
  out.add_row(0, row);
  return out;
}

TEST(Junit, HasOneCasePerExpectationAndCountsThatAgree) {
  const Report r = sample();
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(junit_xml({&r}).c_str()));
  const auto suite = document.child("testsuites").child("testsuite");
  std::set<std::string> names;
  int cases = 0, failures = 0, errors = 0;
  for (const auto node : suite.children("testcase")) {
    ++cases;
    failures += node.child("failure") ? 1 : 0;
    errors += node.child("error") ? 1 : 0;
    EXPECT_FALSE(node.child("failure") && node.child("error"));
    names.insert(std::string(node.attribute("classname").value()) + node.attribute("name").value());
  }
  EXPECT_EQ(cases, 3);
  EXPECT_EQ(names.size(), 3u);
  EXPECT_EQ(suite.attribute("tests").as_int(), cases);
  EXPECT_EQ(suite.attribute("failures").as_int(), failures);
  EXPECT_EQ(suite.attribute("errors").as_int(), errors);
  EXPECT_STREQ(suite.attribute("name").value(), r.plan.c_str());
}

TEST(Junit, RepeatsTheMessageAndHasNoControlCharacters) {
  const Report r = sample();
  const std::string xml = junit_xml({&r});
  EXPECT_EQ(xml.find('\x01'), std::string::npos);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(xml.c_str()));
  const auto failure = document.select_node("//failure").node();
  EXPECT_STREQ(failure.attribute("message").value(), failure.text().get());
  EXPECT_NE(std::string(failure.text().get()).find("at most 5 cm"), std::string::npos);
}

TEST(Junit, ABadRunIsAnErrorOfItsLastCase) {
  Report r = sample();
  r.expectations.pop_back();
  r.reasons = {{Blame::harness, "the board fell silent"}};
  conclude(r);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(junit_xml({&r}).c_str()));
  EXPECT_STREQ(document.select_node("//error").node().attribute("message").value(),
               "the board fell silent");
}

TEST(RunJson, WritesNullForWhatCouldNotBeMeasured) {
  const auto json = parse_json(run_json(sample()));
  EXPECT_TRUE(json["expectations"][1]["measured"].is_null());
  EXPECT_EQ(json["expectations"][0]["limit"], 5.0);
  EXPECT_EQ(json["verdict"], "fail");
}

TEST(RunJson, DoubtsAreToldThereAndOnThePageAndNoVerdictFollowsFromThem) {
  Report r = sample();
  r.expectations.pop_back();
  conclude(r);
  ASSERT_EQ(r.verdict, Verdict::pass);
  r.doubts = {"propeller: of a make that nobody measured"};
  conclude(r);
  EXPECT_EQ(r.verdict, Verdict::pass);
  EXPECT_EQ(parse_json(run_json(r))["doubts"][0], r.doubts[0]);
  EXPECT_NE(page_html(r, Curves{}).find(r.doubts[0]), std::string::npos);
}

TEST(ChartsCsv, CurvesAndFiguresWithNotesAreRowsWhoseFieldsStayWhole) {
  Chart chart{"g;1", "t", "x", "y", "", "5 \"points\"", {}, {}};
  chart.curves.push_back({"a", {1.0, 2.0}, {0.5, 0.25}});
  chart.figures.push_back({"mine: CT, WMAPE", 3.5, std::numeric_limits<double>::infinity(), "%"});
  chart.figures.push_back({"speed", 1.0, 3.0, "%"});
  EXPECT_EQ(
      curves_csv({chart}),
      "group;chart;curve;x_label;x;y_label;y\n\"g;1\";t;a;x;1;y;0.5\n\"g;1\";t;a;x;2;y;0.25\n");
  EXPECT_EQ(figures_csv({chart}),
            "group;chart;figure;value;unit;limit;note\n\"g;1\";t;mine: CT, WMAPE;3.5;%;;\n"
            "\"g;1\";t;speed;1;%;3;\n\"g;1\";t;;;;;\"5 \"\"points\"\"\"\n");
}

// All bytes, as firmware may send them through t:ask: every file stays well-formed and keeps them
// apart.
TEST(Results, AnyBytesGiveWellFormedFiles) {
  std::string bytes;
  for (int i = 1; i <= 256; ++i) bytes += static_cast<char>(i);  // the zero, which ends C's, last
  Report r = sample();
  r.plan = r.file = r.reason = r.digest = bytes;
  r.verdict = Verdict::error;
  r.tags = {bytes};
  r.versions = {{bytes, bytes}};
  r.log = r.findings = r.steps = {{0.0, bytes, bytes}};
  r.cpu_faults = {{bytes, bytes, bytes, bytes, 0.0}};
  r.tasks = {{bytes}};
  for (Expectation& e : r.expectations) {
    e.name += bytes;
    e.note = e.how = e.unit = e.place = bytes;
    e.signals = {bytes};
  }
  pugi::xml_document document;
  const std::string xml = junit_xml({&r});
  ASSERT_TRUE(document.load_string(xml.c_str()));
  EXPECT_EQ(xml, legal_text(xml));
  const auto json = parse_json(run_json(r));
  EXPECT_EQ(json["plan"], legal_text(bytes));
  EXPECT_EQ(legal_text(page_html(r, curves())), page_html(r, curves()));
  const std::string charts = charts_html(bytes, bytes,
                                         {{bytes,
                                           bytes,
                                           bytes,
                                           bytes,
                                           bytes,
                                           bytes,
                                           {{bytes, {1.0}, {1.0}}},
                                           {{bytes, 1.0, 2.0, bytes, true}}}});
  EXPECT_EQ(legal_text(charts), charts);
}

nlohmann::json data_of(const std::string& page) {
  const auto begin = page.find("application/json\">") + 18;
  return parse_json(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(Page, IsOneFileWithoutNetworkAndKeepsEverySpike) {
  const std::string page = page_html(sample(), curves());
  for (const char* outside : {"http://", "https://", "src=", "<link"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  const auto data = data_of(page);
  const auto& height = data["signals"][0]["high"];
  EXPECT_EQ(*std::max_element(height.begin(), height.end()), 9.0);
  EXPECT_EQ(data["signals"][2]["constant"], 1.0);
  EXPECT_TRUE(data["signals"][1]["low"][0].is_null());
}

TEST(Page, ShowsTheStackOfEachTask) {
  Report r = sample();
  r.statistics_json =
      R"({"stack_used_bytes":300,"task_stacks":[{"stack":"idle_stack","top":"0x1","used_bytes":64}]})";
  const auto stacks = data_of(page_html(r, curves()))["stacks"];
  ASSERT_EQ(stacks.size(), 2u);
  EXPECT_EQ(stacks[0]["used_bytes"], 300);
  EXPECT_EQ(stacks[1]["stack"], "idle_stack");
  EXPECT_EQ(stacks[1]["used_bytes"], 64);
}

TEST(Page, SaysWhichCallsWereTheLongestAndWhatTheModelLeavesOut) {
  Report r = sample();
  r.statistics_json =
      R"({"core_waits_for_dma_at_most_ns": 250000, "watched": [{"name": "f", "worst_execution": {}}]})";
  const auto said = data_of(page_html(r, curves()));
  EXPECT_EQ(said["watched"].size(), 1u);
  EXPECT_EQ(said["watched"][0]["name"], "f");
  EXPECT_EQ(said["dma_wait_at_most_s"], 250e-6);
  for (const char* text : {"", "{}", "[]", R"({"core_waits_for_dma_at_most_ns": "much"})"}) {
    r.statistics_json = text;
    EXPECT_EQ(data_of(page_html(r, curves()))["dma_wait_at_most_s"], 0.0) << text;
    EXPECT_TRUE(data_of(page_html(r, curves()))["watched"].empty()) << text;
  }
}

TEST(Page, NoTextOfAPlanEndsTheScript) {
  Report r = sample();
  r.reason = "</script><b>";
  const std::string page = page_html(r, curves());
  EXPECT_EQ(page.find("</script><b>"), std::string::npos);
}

// "<!--<script>" makes a browser read on over the next "</script>", to a blank page.
TEST(Page, NoTextOfAPlanBeginsAComment) {
  Report r = sample();
  r.plan = "<!--<script>";
  const std::string page = page_html(r, curves());
  EXPECT_EQ(page.find("<!--"), std::string::npos);
  EXPECT_NE(page.find("\\u003c!--\\u003cscript>"), std::string::npos);
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST(RunFolder, LatestPointsAtTheNewestAndNoRunOverwritesAnother) {
  const ScratchFolder folder;
  Report r = sample();
  std::string paths[2];
  for (std::string& path : paths) {
    auto made = RunFolder::create(folder.path(), r.plan);
    ASSERT_TRUE(made.ok());
    MessageWriter messages = messages_of(made.value());
    ASSERT_TRUE(write_run(made.value(), r, messages));
    const auto published = made.value().publish("");
    ASSERT_TRUE(published.ok());
    path = published.value();
  }
  EXPECT_NE(paths[0], paths[1]);
  EXPECT_EQ(fs::canonical(folder.file("runs/latest")), fs::canonical(paths[1]));
}

TEST(RunFolder, HasItsNameOnlyWhenAllIsInIt) {
  const ScratchFolder folder;
  {
    auto made = RunFolder::create(folder.path(), "p");
    ASSERT_TRUE(made.ok());
    const auto names = names_in(folder.file("runs"));
    ASSERT_EQ(names.size(), 1u);
    EXPECT_TRUE(names[0].starts_with(".unfinished-")) << names[0];
    ASSERT_TRUE(write_text(made.value().file("run.json"), "{}").ok());
    const auto published = made.value().publish("interrupted");
    ASSERT_TRUE(published.ok());
    EXPECT_TRUE(published.value().ends_with("-p-interrupted")) << published.value();
  }
  const auto names = names_in(folder.file("runs"));
  ASSERT_EQ(names.size(), 2u);  // and latest
  EXPECT_EQ(names_in(folder.file("runs/latest")), std::vector<std::string>{"run.json"});
}

TEST(RunFolder, AnEmptyOneLeavesNothing) {
  const ScratchFolder folder;
  { ASSERT_TRUE(RunFolder::create(folder.path(), "p").ok()); }
  EXPECT_TRUE(names_in(folder.file("runs")).empty());
}

TEST(RunFolder, WhatCannotBeWrittenIsAReasonAndTheRestIsThere) {
  const ScratchFolder folder;
  auto made = RunFolder::create(folder.path(), "p");
  ASSERT_TRUE(made.ok());
  fs::create_directory(made.value().file("truth.csv"));  // in the way
  Report passed = sample();
  passed.expectations.pop_back();
  conclude(passed);
  ASSERT_EQ(exit_code(passed), 0);
  MessageWriter messages = messages_of(made.value());
  EXPECT_FALSE(write_run(made.value(), passed, messages));
  EXPECT_EQ(exit_code(passed), 3);
  const auto json = parse_json(contents(made.value().file("run.json")));
  EXPECT_EQ(json["verdict"], "inconclusive");
  EXPECT_NE(json["reason"].get<std::string>().find("results lost"), std::string::npos);
  EXPECT_NE(contents(made.value().file("junit.xml")).find("results lost"), std::string::npos);
  fs::create_directory(made.value().file("bus.csv.x"));
  Report failed = sample();
  fs::create_directories(made.value().file("truth.csv") + "/x");
  MessageWriter again = messages_of(made.value());
  EXPECT_FALSE(write_run(made.value(), failed, again));
  EXPECT_EQ(exit_code(failed), 1);  // what was seen of the firmware stays
}

}  // namespace
}  // namespace whirl::results

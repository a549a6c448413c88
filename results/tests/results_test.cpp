#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>

#include "harness/base/scratch_folder.hpp"
#include "results/folder.hpp"
#include "results/history.hpp"

namespace whirl::results {
namespace {

namespace fs = std::filesystem;

Report sample() {
  Report r;
  r.plan = "hover <1> & \"quoted\"";
  r.file = "hover.lua";
  r.seed = 7;
  r.digest = "0123456789abcdef";
  r.virtual_s = 10.0;
  Expectation good;
  good.name = "height";
  good.verdict = Verdict::pass;
  good.how = "at most";
  good.measured = 3.0;
  good.high = 5.0;
  good.unit = "cm";
  good.margin = 2.0;
  Expectation bad = good;
  bad.name = "tilt \x01";
  bad.verdict = Verdict::fail;
  bad.measured = std::nan("");
  bad.note = "nothing to measure";
  r.expectations = {good, bad};
  conclude(r);
  return r;
}

std::string contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Verdicts, PrecedenceIsInternalBadInputFailedInconclusivePass) {
  const int order[] = {0, 3, 1, 2, 4};
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 5; ++k) {
      EXPECT_EQ(worse_exit_code(order[i], order[k]), order[std::max(i, k)]);
    }
  }
  EXPECT_EQ(worse_exit_code(0, 139), 4);  // an unknown code is nobody's pass
}

TEST(Verdicts, NothingExpectedIsBadInput) {
  Report r;
  conclude(r);
  EXPECT_EQ(exit_code(r), 2);
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
  r.verdict = Verdict::error;
  r.reason = "the board fell silent";
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(junit_xml({&r}).c_str()));
  EXPECT_STREQ(document.select_node("//error").node().attribute("message").value(),
               "the board fell silent");
}

TEST(RunJson, WritesNullForWhatCouldNotBeMeasured) {
  const auto json = nlohmann::json::parse(run_json(sample()));
  EXPECT_TRUE(json["expectations"][1]["measured"].is_null());
  EXPECT_EQ(json["expectations"][0]["limit"], 5.0);
  EXPECT_EQ(json["verdict"], "fail");
}

TruthLog truth() {
  TruthLog log({{"height", "m", "m"}, {"climb", "mps", "m/s"}, {"armed", "", ""}}, 1'000'000);
  for (int i = 0; i < 5000; ++i) {
    const double row[] = {i == 2500 ? 9.0 : 1.0, std::nan(""), 1.0};
    log.append(row);
  }
  return log;
}

TEST(Truth, ColumnsCarryTheirUnits) {
  const ScratchFolder folder;
  ASSERT_TRUE(truth().write_csv(folder.file("truth.csv")).ok());
  const std::string csv = contents(folder.file("truth.csv"));
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "t_s,height_m,climb_mps,armed");
  EXPECT_NE(csv.find("\n2.5,9,nan,1\n"), std::string::npos);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5001);
}

TEST(Truth, ALongRunKeepsEveryThirdRowInItsFile) {
  const ScratchFolder folder;
  TruthLog log({{"height", "m", "m"}}, 1'000'000);
  for (int i = 0; i < 450'001; ++i) {
    const double row[] = {i == 449'997 ? 9.0 : 1.0};  // a multiple of three
    log.append(row);
  }
  ASSERT_TRUE(log.write_csv(folder.file("truth.csv")).ok());
  const std::string csv = contents(folder.file("truth.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 150'001);
  EXPECT_NE(csv.find("\n449.997,9\n"), std::string::npos);
}

TEST(Page, IsOneFileWithoutNetworkAndKeepsEverySpike) {
  const std::string page = page_html(sample(), truth());
  for (const char* outside : {"http://", "https://", "src=", "<link"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  const auto begin = page.find("application/json\">") + 18;
  const auto data =
      nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  const auto& height = data["signals"][0]["high"];
  EXPECT_EQ(*std::max_element(height.begin(), height.end()), 9.0);
  EXPECT_EQ(data["signals"][2]["constant"], 1.0);
  EXPECT_TRUE(data["signals"][1]["low"][0].is_null());
}

TEST(Page, NoTextOfAPlanEndsTheScript) {
  Report r = sample();
  r.reason = "</script><b>";
  const std::string page = page_html(r, truth());
  EXPECT_EQ(page.find("</script><b>"), std::string::npos);
}

TEST(RunFolder, LatestPointsAtTheNewestAndNoRunOverwritesAnother) {
  const ScratchFolder folder;
  Report r = sample();
  const EventLog events;
  const auto first = make_run_folder(folder.path(), r.plan),
             second = make_run_folder(folder.path(), r.plan);
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_NE(first.value(), second.value());
  ASSERT_TRUE(write_run(second.value(), r, truth(), events).ok());
  EXPECT_EQ(fs::canonical(folder.file("runs/latest")), fs::canonical(second.value()));
}

TEST(Events, ATruncatedBatchIsNoticed) {
  io::Batch batch;
  batch.add(io::Kind::data_ready, 0, 5, nullptr, 0);
  io::Batch cut;
  cut.assign(batch.bytes().first(batch.bytes().size() - 1));
  EventLog log;
  EXPECT_TRUE(log.add(batch));
  EXPECT_FALSE(log.add(cut));
}

TEST(Events, BusyShareCountsWholePiecesOfTheWindow) {
  EventLog log;
  log.busy = {{0, 100, 90}, {100, 200, 20}, {200, 300, 40}, {300, 400, 90}};
  EXPECT_EQ(log.busy_share(100, 350), 0.3);
  EXPECT_TRUE(std::isnan(log.busy_share(110, 190)));
}

TEST(History, GivesTheLastRunsOldestFirst) {
  const ScratchFolder folder;
  const std::string file = folder.file("history.sqlite");
  for (int i = 0; i < 5; ++i) {
    Report r = sample();
    r.seed = static_cast<std::uint64_t>(i);
    r.expectations[0].margin = i;
    ASSERT_TRUE(remember(file, r).ok());
  }
  const auto rows = recall(file, sample().plan, "height", 3);
  ASSERT_TRUE(rows.ok());
  ASSERT_EQ(rows.value().size(), 3u);
  EXPECT_EQ(rows.value().front().margin, 2.0);
  EXPECT_EQ(rows.value().back().margin, 4.0);
  const auto unmeasured = recall(file, "", "tilt", 1);
  EXPECT_TRUE(std::isnan(unmeasured.value().at(0).measured));
  EXPECT_FALSE(recall(folder.file("none.sqlite"), "", "", 1).ok());
}

}  // namespace
}  // namespace whirl::results

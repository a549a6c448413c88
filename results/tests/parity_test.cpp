#include "results/parity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace whirl::results {
namespace {

Expectation figure(const std::string& name, double measured, bool met) {
  Expectation e;
  e.name = name;
  e.measured = measured;
  e.verdict = met ? Verdict::pass : Verdict::fail;
  return e;
}

TEST(Parity, FiguresMeetByNameAndOrder) {
  Report first, second;
  first.expectations = {figure("rise", 20.0, true), figure("again", 1.0, true),
                        figure("again", 2.0, true), figure("peak", 5.0, true)};
  second.expectations = {figure("again", 1.0, true), figure("rise", 19.0, false),
                         figure("again", 3.0, true), figure("new", 7.0, true)};
  const auto rows = parity(first, second);
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_TRUE(near(rows[0].difference, -0.05, round_off(2, 1.0)));
  EXPECT_TRUE(rows[0].first_met);
  EXPECT_FALSE(rows[0].second_met);
  EXPECT_EQ(rows[2].second, 3.0);
  EXPECT_FALSE(rows[3].in_both);
  EXPECT_TRUE(std::isnan(rows[3].second));
  EXPECT_EQ(rows[4].name, "new");
  EXPECT_FALSE(rows[4].in_both);
}

TEST(Parity, MarksWhatMovesByMoreThanFivePercentEitherWay) {
  Report first, second;
  first.expectations = {figure("same", -20.0, true), figure("less", 20.0, true),
                        figure("more", -20.0, true)};
  second.expectations = {figure("same", -20.9, true), figure("less", 18.9, true),
                         figure("more", -18.9, true)};
  first.verdict = Verdict::pass;
  second.versions = {{"flight/image", "a"}, {"esc1/image", "b"}};
  const auto rows = parity(first, second);
  EXPECT_FALSE(rows[0].marked());
  EXPECT_TRUE(rows[1].marked());
  EXPECT_TRUE(rows[2].marked());
  const std::string text = parity_text(first, second), page = parity_page(first, second);
  EXPECT_NE(text.find("-5.50 % *"), std::string::npos);
  EXPECT_NE(page.find("class=\"no\">-5.50 % *"), std::string::npos);
  EXPECT_NE(text.find("virtual board (pass) beside 2 virtual boards"), std::string::npos) << text;
}

TEST(Parity, WhatWasZeroAndIsNotIsMarkedWithoutAShare) {
  const double nan = std::nan("");
  Report first, second;
  first.expectations = {figure("up", 0.0, true),      figure("down", 0.0, true),
                        figure("still", 0.0, true),   figure("gone", 0.0, true),
                        figure("to zero", 3.0, true), figure("came", nan, false)};
  second.expectations = {figure("up", 9.0, true),      figure("down", -1e-9, true),
                         figure("still", -0.0, true),  figure("gone", nan, false),
                         figure("to zero", 0.0, true), figure("came", 0.0, true)};
  const auto rows = parity(first, second);
  const bool marked[] = {true, true, false, false, true, false};
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].marked(), marked[i]) << i;
  const std::string text = parity_text(first, second), page = parity_page(first, second);
  for (const std::string& shown : {text, page}) {
    EXPECT_NE(shown.find("from 0 *"), std::string::npos) << shown;
    EXPECT_NE(shown.find("+0.00 %"), std::string::npos) << shown;
    EXPECT_NE(shown.find("-100.00 % *"), std::string::npos) << shown;
    EXPECT_EQ(shown.find("inf"), std::string::npos) << shown;
  }
}

TEST(Parity, LimitsThatAreNotTheSameAreBothToldAndMarked) {
  Report first, second;
  const auto at_most = [](const std::string& name, double high, const std::string& unit) {
    Expectation e = figure(name, 20.0, true);
    e.how = "at most";
    e.high = high;
    e.unit = unit;
    return e;
  };
  first.expectations = {at_most("same", 50.0, "ms"), at_most("wider", 50.0, "ms"),
                        at_most("other", 50.0, "ms"), at_most("alone", 50.0, "ms")};
  second.expectations = {at_most("same", 50.0, "ms"), at_most("wider", 60.0, "ms"),
                         at_most("other", 50.0, "s")};
  const auto rows = parity(first, second);
  const bool differ[] = {false, true, true, false};
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].limits_differ(), differ[i]) << i;
  EXPECT_NE(parity_text(first, second).find("at most 50 ms; second: at most 60 ms *\n"),
            std::string::npos)
      << parity_text(first, second);
  EXPECT_NE(parity_page(first, second).find("class=\"no\">at most 50 ms; second: at most 60 ms *"),
            std::string::npos);
}

TEST(Parity, PageAndTextNameWhatDiffersAndEscapeWhatUsersWrote) {
  Report first, second;
  first.plan = "a <plan>";
  first.expectations = {figure("rise & <fall>", 20.0, true)};
  second.expectations = {figure("rise & <fall>", 25.0, false)};
  second.versions = {{"bench", "b.lua"}};
  const std::string page = parity_page(first, second), text = parity_text(first, second);
  EXPECT_NE(page.find("rise &amp; &lt;fall>"), std::string::npos);
  EXPECT_EQ(page.find("<plan>"), std::string::npos);
  for (const std::string& shown : {page, text}) {
    EXPECT_NE(shown.find("+25.00 %"), std::string::npos);
    EXPECT_NE(shown.find("first only"), std::string::npos);
    EXPECT_NE(shown.find("b.lua"), std::string::npos);
  }
}

TEST(Verdicts, AHostThatWasLateTakesPassAndFailAway) {
  for (const bool met : {true, false}) {
    Report report;
    report.expectations = {figure("rise", 20.0, met)};
    report.untimely = "the host was late";
    conclude(report);
    EXPECT_EQ(report.verdict, Verdict::inconclusive);
    EXPECT_EQ(exit_code(report), 3);
    EXPECT_EQ(report.reason, "the host was late");
  }
  Report bad;
  bad.untimely = "the host was late";
  bad.reasons = {{Blame::user, "no such file"}};
  conclude(bad);
  EXPECT_EQ(exit_code(bad), 2);  // what the user has to mend stays
}

}  // namespace
}  // namespace whirl::results

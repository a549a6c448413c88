// What is judged over a time: guards, their ends, and what was not watched whole.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "harness/tests/oracle/by_hand.hpp"

namespace whirl::oracle {
namespace {

// x rises by a millimetre per ms from 1 m.
TEST(Guards, SayHowMuchOfTheirTimeWasWatched) {
  const auto note = [](const std::string& lua) { return only(with_two_signals(lua)).note; };
  EXPECT_EQ(note("t:wait '50 ms' t:always('y', '1 s'):at_most '9 N' t:wait '100 ms'"),
            "only 100 ms of 1000 ms were watched when the run ended");
  EXPECT_EQ(
      note("t:wait '50 ms' t:budget('fw::task') { execution = '1 s', during = '200 ms' } t:wait "
           "'100 ms'"),
      "only 100 ms of 200 ms were watched when the run ended; nothing to measure");
  EXPECT_EQ(note("t:wait '50 ms' t:always('y'):at_most '9 N'"),
            "was never watched: its time is empty");
  EXPECT_EQ(note("local g = t:always('y'):at_most '9 N' g:stop() t:wait '9 ms'"),
            "was never watched: its time is empty");
  EXPECT_EQ(note("t:always('c', function() return true end)"),
            "was never watched: its time is empty");
  const results::Report cut = report_of(with_two_signals(
      "t:wait '50 ms' t:always('y'):at_most '9 N' t:wait '100 ms' error 'broken'"));
  ASSERT_EQ(cut.expectations.size(), 1u);
  EXPECT_EQ(cut.expectations[0].note, "the run was cut off after 100 ms of watching");
  EXPECT_EQ(cut.expectations[0].verdict, results::Verdict::inconclusive);
}

// From now on: the step at which it is set counts, of a signal and of a condition.
TEST(Guards, LookAtTheStepAtWhichTheyAreSet) {
  const auto violated = [](const std::string& lua) {
    return only(with_signal(lua, [](int ms) { return ms == 50 ? 2.0 : 1.0; })).verdict ==
           results::Verdict::fail;
  };
  const std::string condition = "t:always('c', function(s) return s.x_m < 1.5 end)";
  for (const std::string& guard : {std::string("t:always('x'):at_most '1.5 m'"), condition}) {
    EXPECT_TRUE(violated("t:wait '50 ms' " + guard + " t:wait '9 ms'")) << guard;
    EXPECT_TRUE(violated("t:wait '50 ms' " + guard)) << guard;
    EXPECT_FALSE(violated("t:wait '51 ms' " + guard + " t:wait '9 ms'")) << guard;
  }
  const results::Expectation first = only(with_signal("t:always('x'):at_most '9 m' t:wait '9 ms'",
                                                      [](int ms) { return ms == 0 ? 2.0 : 1.0; }));
  EXPECT_EQ(first.measured, 2.0);  // of the very first step
}

TEST(Guards, TellTheWorstValueAndWhenItFirstHappened) {
  // Up to 1.2 m at 40 ms and again at 70 ms.
  const auto peaks = [](const std::string& lua) {
    return only(with_signal(lua, [](int ms) { return ms == 40 || ms == 70 ? 1.2 : 1.0; }));
  };
  const results::Expectation most =
      peaks("t:wait '10 ms' t:always('x', '80 ms'):at_most '1.1 m' t:wait '100 ms'");
  EXPECT_EQ(most.name, "x, always");
  EXPECT_EQ(most.measured, 1.2);
  EXPECT_TRUE(near(most.t_s, 0.04, round_off(4, 1)));
  EXPECT_TRUE(near(most.from_s, 0.01, round_off(4, 1)));
  EXPECT_TRUE(near(most.to_s, 0.09, round_off(4, 1)));
  EXPECT_TRUE(most.level);
  EXPECT_EQ(most.signals, std::vector<std::string>{"x"});
  EXPECT_EQ(most.verdict, results::Verdict::fail);
  const results::Expectation flat =
      peaks("t:wait '75 ms' t:always('x'):within('0.5 m', '1.4 m') t:wait '20 ms'");
  EXPECT_TRUE(near(flat.t_s, 0.075, round_off(4, 1)));
  EXPECT_TRUE(near(flat.to_s, 0.095, round_off(4, 1)));
  EXPECT_TRUE(near(flat.margin, 0.4, round_off(8, 1)));
  EXPECT_EQ(peaks("t:always('x'):at_least '1.2 m' t:wait '50 ms'").measured, 1.0);
}

TEST(Guards, AHoleInASignalIsTheWorst) {
  const results::Expectation e = only(with_signal("t:always('x'):at_most '9 m' t:wait '50 ms'",
                                                  [](int ms) { return ms == 30 ? kNaN : 1.0; }));
  EXPECT_TRUE(std::isnan(e.measured));
  EXPECT_TRUE(std::isnan(e.margin));
  EXPECT_EQ(e.note, "nothing to measure");
  EXPECT_EQ(e.verdict, results::Verdict::fail);
  EXPECT_TRUE(near(e.t_s, 0.03, round_off(4, 1)));
}

// Both ends of a guard's time belong to it; x is 1.005 m after 5 ms.
TEST(Guards, EndWithTheirLastStep) {
  const auto verdict = [](const std::string& lua) { return only(with_two_signals(lua)).verdict; };
  EXPECT_EQ(verdict("t:always('x', '5 ms'):at_most '1.0055 m' t:wait '20 ms'"),
            results::Verdict::pass);
  EXPECT_EQ(verdict("t:always('x', '5 ms'):at_most '1.0045 m' t:wait '20 ms'"),
            results::Verdict::fail);
  const auto violated = [](const std::string& limit) {
    return only(with_two_signals("t:always('c', function(s) return s.x_m < " + limit +
                                 " end, '5 ms') t:wait '20 ms'"));
  };
  EXPECT_TRUE(near(violated("1.0045").measured, 0.001, round_off(4, 1)));
  EXPECT_EQ(violated("1.0055").measured, 0.0);
  EXPECT_EQ(violated("1.0055").t_s, 0.0);
  EXPECT_EQ(violated("1.0055").note, "");
  EXPECT_EQ(violated("1.0045").name, "c (time violated)");
  EXPECT_TRUE(near(violated("1.0025").t_s, 0.003, round_off(4, 1)));
  EXPECT_EQ(violated("1.0025").note, "first violated at 0.003000 s");
}

TEST(Guards, AStopEndsAGuardAndNeverProlongsIt) {
  const auto passes_with = [](const std::string& stop) {
    return passes(with_two_signals("local g = t:always('x', '10 ms'):at_most '1.0105 m' " + stop));
  };
  EXPECT_TRUE(passes_with("t:wait '50 ms' g:stop()"));
  EXPECT_TRUE(passes_with("t:wait '5 ms' g:stop() t:wait '50 ms'"));
  EXPECT_TRUE(passes(with_two_signals(
      "local g = t:always('x'):at_most '1.0105 m' t:wait '10 ms' g:stop() t:wait '50 ms'")));
  EXPECT_FALSE(passes(with_two_signals(
      "local g = t:always('x'):at_most '1.0105 m' t:wait '11 ms' g:stop() t:wait '50 ms'")));
}

TEST(Guards, AThousandAreAllowedAndWatchAtOnce) {
  const auto with = [](int guards, const std::string& guard) {
    return report_of(with_two_signals("for i = 1, " + std::to_string(guards) + " do " + guard +
                                      " end t:wait '9 ms'"));
  };
  const results::Report report = with(1000, "t:always('c', function(s) return s.x_m < 9 end)");
  EXPECT_EQ(report.reason, "");
  EXPECT_EQ(report.expectations.size(), 1000u);
  EXPECT_EQ(with(1000, "t:always('x'):at_most '9 m'").reason, "");
  EXPECT_NE(with(1001, "t:always('x'):at_most '9 m'").reason.find("more than 1000 guards"),
            std::string::npos);
  EXPECT_EQ(with(1000, "t:budget('cpu') { busy = '9 %' }").expectations.size(), 1000u);
  EXPECT_NE(with(1001, "t:budget('cpu') { busy = '9 %' }").reason.find("more than 1000 budgets"),
            std::string::npos);
}

TEST(Guards, OneExpectationMayHaveTwoLimits) {
  const results::Report report =
      report_of(with_two_signals("t:expect(t:value 'x'):at_most('9 m'):at_least '0.5 m' "
                                 "t:always('y'):within('1 N', '3 N') t:wait '9 ms'"));
  ASSERT_EQ(report.expectations.size(), 3u) << report.reason;
  EXPECT_EQ(report.expectations[0].how, "at most");
  EXPECT_EQ(report.expectations[1].how, "at least");
  EXPECT_EQ(report.expectations[1].name, "x (2)");
  EXPECT_EQ(report.expectations[2].how, "within");
  EXPECT_EQ(report.expectations[2].limits_SI, (std::vector<double>{1.0, 3.0}));
}

TEST(Guards, AGuardsLimitGivesTheGuard) {
  EXPECT_TRUE(passes(with_two_signals(
      "local g = t:always('x'):at_most('1.0105 m') t:wait '5 ms' g:stop() t:wait '50 ms'")));
}

// At each step the conditions have the budget of Lua once, and the script's turn has it once.
TEST(Guards, HaveABudgetOfTheirOwn) {
  const auto reason = [](int in_condition, int in_script) {
    const auto loop = [](int n) { return " for i = 1, " + std::to_string(n) + " do end "; };
    Scenario s = with_two_signals("t:always('c', function(s)" + loop(in_condition) +
                                  "return s.x_m < 9 end) for i = 1, 3 do t:wait '1 ms'" +
                                  loop(in_script) + "end ");
    s.limits.instructions = 100'000;
    return report_of(s).reason;
  };
  EXPECT_EQ(reason(70'000, 70'000), "");
  EXPECT_NE(reason(130'000, 0).find("endless loop?"), std::string::npos);
  EXPECT_NE(reason(0, 130'000).find("endless loop?"), std::string::npos);
}

// A limit may be a single value, and a value on it meets it.
TEST(Limits, AreMetByTheValueOnThem) {
  const auto passes_with = [](const std::string& limit) {
    return passes(with_two_signals("t:expect(t:value 'y')" + limit + " t:wait '1 ms'"));
  };
  EXPECT_TRUE(passes_with(":within('2 N', '2 N')"));
  EXPECT_TRUE(passes_with(":equal '2 N'"));
  EXPECT_TRUE(passes_with(":at_most '2 N'"));
  EXPECT_TRUE(passes_with(":at_least '2 N'"));
  EXPECT_FALSE(passes_with(":equal '2.0000000001 N'"));
  EXPECT_FALSE(passes_with(":at_most '1.9999999999 N'"));
  EXPECT_FALSE(passes_with(":at_least '2.0000000001 N'"));
  const results::Expectation e = only(with_two_signals("t:expect(t:value 'y'):equal '2 N'"));
  EXPECT_EQ(e.limits_SI, std::vector<double>{2.0});
}

// A time is whole nanoseconds: less than a picosecond is rounding, more is not.
TEST(Limits, OfATimeForgiveItsRoundingAndNoMore) {
  const auto passes_at = [](double beyond_s, const std::string& limit) {
    Scenario s = with_two_signals("t:expect(t:value 'late')" + limit + " t:wait '1 ms'");
    s.signals.push_back({"late", Dimension::time, [=](int) { return 1e-3 + beyond_s; }});
    return passes(s);
  };
  EXPECT_TRUE(passes_at(0.995e-12, ":at_most '1 ms'"));
  EXPECT_FALSE(passes_at(1.005e-12, ":at_most '1 ms'"));
  EXPECT_TRUE(passes_at(-0.995e-12, ":at_least '1 ms'"));
  EXPECT_FALSE(passes_at(-1.005e-12, ":at_least '1 ms'"));
}

TEST(Limits, AreInTheirOwnUnitAndSoIsTheMargin) {
  Scenario s = with_two_signals("t:expect(t:value 'warm'):at_most '30 degC' t:wait '1 ms'");
  s.signals.push_back({"warm", Dimension::temperature, [](int) { return 293.15; }});
  const results::Expectation e = only(s);
  EXPECT_TRUE(near(e.measured, 20.0, round_off(8, 300)));
  EXPECT_TRUE(near(e.margin, 10.0, round_off(8, 300)));
  EXPECT_EQ(e.unit, "degC");
}

// To Lua 0 is true: s.told_armed alone held while it was 0.
TEST(Guards, AConditionIsTrueOrFalse) {
  for (const char* call : {"t:within('20 ms', function(s) return s.x_m end)",
                           "t:wait_until(function(s) return s.x_m end, '20 ms')",
                           "t:always('x', function(s) return s.x_m end) t:wait '9 ms'",
                           "t:within('20 ms', function(s) local x = s.x_m end)"}) {
    const results::Report report = report_of(with_two_signals(call));
    EXPECT_EQ(results::exit_code(report), 2) << call;
    EXPECT_NE(report.reason.find("a condition is true or false"), std::string::npos)
        << report.reason;
    EXPECT_NE(report.reason.find("plan.lua:2"), std::string::npos) << report.reason;
  }
}

TEST(Guards, AConditionCannotWait) {
  const results::Report report =
      report_of(with_two_signals("t:within('20 ms', function(s) t:wait '1 ms' return true end)"));
  EXPECT_EQ(results::exit_code(report), 2);
  EXPECT_NE(report.reason.find("plan.lua:2: a condition looks at a moment"), std::string::npos)
      << report.reason;
}

}  // namespace
}  // namespace whirl::oracle

// What a record is asked, in each of its forms, and what plain values and answers are.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "harness/tests/oracle/by_hand.hpp"

namespace whirl::oracle {
namespace {

// x steps from 0 m to 2 m at 300 ms, over 1.9 m at 310 ms; n and e are its like with 0.3 and 0.4 of it.
Scenario stepping(const std::string& lua) {
  const auto x = [](int ms) { return ms < 300 ? 0.0 : ms < 310 ? 1.5 : ms < 320 ? 1.9 : 2.0; };
  Scenario s = with_signal(lua, x);
  s.signals.push_back({"n", Dimension::length, [=](int ms) { return 0.3 * x(ms); }});
  s.signals.push_back({"e", Dimension::length, [=](int ms) { return 0.4 * x(ms); }});
  return s;
}

results::Expectation asked(const std::string& record, const std::string& metric,
                           const std::string& limit = "'9 m'") {
  return only(stepping("t:wait '300 ms' local r = t:record(" + record +
                       ", '400 ms') t:expect(r:" + metric + "):at_most " + limit));
}

TEST(Records, SettleInEachOfTheirForms) {
  struct Form {
    const char *record, *metric, *name;
    double settled_ms;
  };
  const Form kForms[] = {
      {"'x'", "settled('20 %')", "x settling time", 10},
      {"'x'", "settled('1 %')", "x settling time", 20},
      {"'x'", "settled('20 cm', '2 m')", "x settling time", 10},
      {"'x'", "settled('20 cm', { x = '2 m' })", "x settling time", 10},
      {"{ 'n', 'x' }", "settled('x', '1 %')", "x settling time", 20},
      {"{ 'n', 'x' }", "settled('x', '20 cm', '2 m')", "x settling time", 10},
      {"{ 'n', 'e' }", "settled('10 cm', { n = '60 cm', e = '80 cm' })", "e, n settling time", 10},
      {"{ 'n', 'e' }", "settled('1 cm', { n = '60 cm', e = '80 cm' })", "e, n settling time", 20},
      {"{ 'n', 'e' }", "settled('6 cm', { n = '60 cm' })", "n settling time", 10},
  };
  for (const Form& form : kForms) {
    const results::Expectation e = asked(form.record, form.metric, "'1000 ms'");
    EXPECT_EQ(e.name, form.name) << form.metric;
    EXPECT_TRUE(near(e.measured, form.settled_ms, round_off(8, 1000))) << form.metric;
    EXPECT_FALSE(e.level);
  }
}

// The record has 401 rows: 10 of 1.5 m, 10 of 1.9 m, 381 of 2 m.
TEST(Records, TellTheirFiguresOfTheRowsFromTheCommandOn) {
  struct Figure {
    const char *record, *metric, *name;
    double value;
    bool level;
  };
  const double mean = (10 * 1.5 + 10 * 1.9 + 381 * 2.0) / 401;
  const double rms = std::sqrt((10 * 2.25 + 10 * 3.61 + 381 * 4.0) / 401);
  const double rms_error = std::sqrt((10 * 0.25 + 10 * 0.01) / 401);
  const Figure kFigures[] = {
      {"'x'", "mean()", "x mean", mean, true},
      {"'x'", "final()", "x final mean", 2.0, true},
      {"'x'", "max()", "x max", 2.0, true},
      {"'x'", "min()", "x min", 1.5, true},
      {"'x'", "rms()", "x RMS", rms, false},
      {"'x'", "p50()", "x p50", 2.0, false},
      {"'x'", "rms_error '2 m'", "x RMS error", rms_error, false},
      {"'x'", "max_error '2 m'", "x max error", 0.5, false},
      {"{ 'n', 'x' }", "min 'x'", "x min", 1.5, true},
      {"{ 'n', 'x' }", "rms_error('x', '2 m')", "x RMS error", rms_error, false},
      {"{ 'n', 'e' }", "max_error { n = '60 cm', e = '80 cm' }", "e, n max error", 0.25, false},
      {"{ 'n', 'e' }", "rms_error { n = '60 cm', e = '80 cm' }", "e, n RMS error", rms_error / 2,
       false},
      {"{ 'n', 'e' }", "max_error { e = '80 cm' }", "e max error", 0.2, false},
  };
  for (const Figure& figure : kFigures) {
    const results::Expectation e = asked(figure.record, figure.metric);
    EXPECT_EQ(e.name, figure.name);
    EXPECT_TRUE(near(e.measured, figure.value, round_off(500, 2))) << figure.name;
    EXPECT_EQ(e.level, figure.level) << figure.name;
    EXPECT_TRUE(near(e.from_s, 0.3, round_off(4, 1)));
    EXPECT_TRUE(near(e.to_s, 0.7, round_off(4, 1)));
  }
}

TEST(Records, HaveQuantilesOfTheirRows) {
  const auto quantile = [](const std::string& which) {  // of 1.050 to 1.250 m in 1 mm
    return only(with_two_signals("t:wait '50 ms' local r = t:record('x', '200 ms') t:expect(r:" +
                                 which + "()):at_most '9 m'"))
        .measured;
  };
  EXPECT_TRUE(near(quantile("p50"), 1.150, round_off(8, 2)));
  EXPECT_TRUE(near(quantile("p99"), 1.248, round_off(8, 2)));
}

TEST(Records, MeasureFromTheirCommand) {
  const auto measured = [](const std::string& metric, const std::string& limit) {
    return only(stepping("t:wait '295 ms' local r = t:record('x', '400 ms') t:expect(r:" + metric +
                         "()):at_most '" + limit + "'"))
        .measured;
  };
  EXPECT_TRUE(near(measured("rise_time", "9000 ms"), 10.75 - 2.0 / 15, round_off(64, 100)));
  EXPECT_TRUE(near(measured("response_time", "9000 ms"), 14.75, round_off(64, 100)));
  EXPECT_EQ(measured("overshoot", "9 %"), 0.0);
  EXPECT_TRUE(std::isnan(measured("fall_time", "9 ms")));
}

// The step comes 100 ms after the command of 250 ms. `wire`: when the last bit of a command had passed.
TEST(Records, AResponseCountsFromTheLastBitOnTheWireIfThatWasWithinTheRecord) {
  const auto response_ms = [](std::int64_t wire_ns) {
    Scenario s = with_signal(
        "t:wait '250 ms' local r = t:record('x', '400 ms', function() t:command { arm = true } "
        "end) "
        "t:expect(r:response_time()):at_most '1000 ms'",
        [](int ms) { return ms < 350 ? 0.0 : 1.0; });
    s.wires_ns[250] = wire_ns;
    return only(s).measured;
  };
  const double from_call = 99.9;  // 0.9 of the way from 349 to 350 ms
  const Tolerance tol = round_off(64, 1000);
  EXPECT_TRUE(near(response_ms(-1), from_call, tol));
  EXPECT_TRUE(near(response_ms(249 * kMs), from_call, tol));  // of an earlier command
  EXPECT_TRUE(near(response_ms(250 * kMs), from_call, tol));
  EXPECT_TRUE(near(response_ms(252 * kMs), from_call - 2.0, tol));
  EXPECT_TRUE(near(response_ms(650 * kMs), from_call - 400.0, tol));
  EXPECT_TRUE(near(response_ms(650 * kMs + 1), from_call, tol));  // it has not passed yet
}

TEST(Records, ReferToTheTwoHundredMillisecondsBeforeThem) {
  // 1 m from 100 to 300 ms, before that 9 m: of a record at 300 ms only the former counts.
  const auto change = [](int begin_ms) {
    return only(with_signal("t:wait '" + std::to_string(begin_ms) +
                                " ms' local r = t:record('x', '400 ms')"
                                " t:expect(r:overshoot()):at_most '900 %'",
                            [](int ms) {
                              return ms < 100 ? 9.0 : ms < 320 ? 1.0 : ms < 330 ? 3.0 : 2.0;
                            }))
        .measured;
  };
  EXPECT_TRUE(near(change(300), 100.0, round_off(64, 100)));
  EXPECT_TRUE(near(change(299), 100.0 / (1.0 - 8.0 / 200), stated(0.1, "one of 9 m in it")));
}

// Each walk over a thousand rows costs a plan 250 instructions.
TEST(Records, CostAPlanWhatTheirRowsCost) {
  const auto reason = [](int means) {
    Scenario s =
        with_two_signals("local r = t:record('x', '1 s') for i = 1, " + std::to_string(means) +
                         " do r:mean() end t:wait '1 ms' " + "t:expect(r:mean()):at_most '9 m'");
    s.limits.instructions = 100'000;
    return report_of(s).reason;
  };
  EXPECT_EQ(reason(200), "");
  EXPECT_NE(reason(420).find("endless loop?"), std::string::npos) << reason(420);
}

TEST(Values, HaveTheirNameTheirTextAndTheirTime) {
  const results::Report report = report_of(with_two_signals(
      "t:wait '7 ms' local m = t:value 'x' t:log(m) t:log(m.name) t:log(m.value) t:log(t:now()) "
      "t:log(t:record('x', '3 ms'):max()) t:log(t:value('idle')) t:log(t:now().name)"
      " t:expect(m):at_most '9 m'"));
  std::vector<std::string> lines;
  for (const results::Note& line : report.log) lines.push_back(line.text);
  EXPECT_EQ(lines,
            (std::vector<std::string>{"1.007 m", "x", "1.007", "0.007 s", "1.01 m", "0 ", "time"}));
  ASSERT_EQ(report.expectations.size(), 1u);
  const results::Expectation& e = report.expectations[0];
  EXPECT_TRUE(e.level);
  EXPECT_EQ(e.signals, std::vector<std::string>{"x"});
  EXPECT_TRUE(near(e.from_s, 0.007, round_off(4, 1)));
  EXPECT_TRUE(near(e.to_s, 0.007, round_off(4, 1)));
  EXPECT_TRUE(near(e.t_s, 0.010, round_off(4, 1)));
}

TEST(Values, OfASignalWithoutAUnitAreReadByItsBareName) {
  EXPECT_TRUE(
      passes(with_two_signals("t:within('5 ms', function(s) return s.idle == 0 and s.y_N == 2 end, "
                              "'idle') t:wait '1 ms'")));
}

// Only what plans may do with what they got is allowed: a number of another measurement is not theirs.
TEST(Values, CountFromZeroAndEndWithTheirLast) {
  const auto reason = [](int number) {
    return report_of(with_two_signals("local m, n = t:value 'x', t:value 'y' m.number = " +
                                      std::to_string(number) +
                                      " t:expect(m):at_most '9 m' t:wait '5 ms'"))
        .reason;
  };
  EXPECT_EQ(reason(0), "");
  EXPECT_NE(reason(1).find("'9 m' is a length, not a force"), std::string::npos) << reason(1);
  EXPECT_NE(reason(2).find("this measurement has been changed"), std::string::npos) << reason(2);
}

TEST(Values, TextsAndDurationsHaveTheirBounds) {
  const auto reason = [](const std::string& lua) {
    return report_of(with_two_signals(lua + " t:expect(t:value 'x'):at_most '9 m' t:wait '1 ms'"))
        .reason;
  };
  EXPECT_EQ(reason("t:step(('x'):rep(4096))"), "");
  EXPECT_NE(reason("t:step(('x'):rep(4097))").find("a step's name of 4097 bytes (4096 are enough)"),
            std::string::npos);
  EXPECT_EQ(reason("t:wait '1 ms'"), "");
  EXPECT_NE(reason("t:wait '999999 ns'").find("'999999 ns' is shorter than a step of 1 ms"),
            std::string::npos);
}

// What only acts gives nothing back.
TEST(Calls, ThatOnlyActGiveNothing) {
  for (const char* call :
       {"t:command { arm = true }", "t:gust {}", "t:fault { kind = 'i2c_nack', bus = 'i2c3' }",
        "t:step 'up'", "t:log 'up'", "t:wait '1 ms'", "g:stop()",
        "t:budget 'fw::task' { execution = '1 s' }", "t:bus { device = 'esc1' }",
        "t:latency { from = 'imu', through = {}, to = 'esc1', at_most = '9 s' }"}) {
    const results::Report report =
        report_of(with_two_signals("local g = t:always('x'):at_most '9 m' local n = select('#', " +
                                   std::string(call) + ") t:log(n) t:wait '5 ms'"));
    ASSERT_FALSE(report.log.empty()) << call << ": " << report.reason;
    EXPECT_EQ(report.log.back().text, "0") << call;
  }
}

TEST(Calls, AFullLogStillGivesNothing) {
  EXPECT_EQ(only(with_two_signals("for i = 1, 5001 do t:log(i) end "
                                  "t:expect(select('#', t:log 'more')):equal(0)"))
                .verdict,
            results::Verdict::pass);
}

TEST(Calls, ThatAnswerGiveOneValue) {
  for (const char* call :
       {"t:value 'x'", "t:value('x', 'cm')", "t:now()", "t:quantity '1 m'", "t:expect(1)",
        "t:expect(1):at_most(2)", "t:always 'x'", "t:always('x'):at_most '1 m'", "t:budget 'cpu'",
        "t:record('x', '1 ms')", "t:record('x', '1 ms'):max()", "t:record('x', '1 ms'):rms()",
        "t:record('x', '1 ms'):max_error '1 m'", "t:record('x', '1 ms'):settled('1 m', '1 m')",
        "t:ask('hello', nil, '2 ms')", "t:wait_until(function() return true end, '1 s')",
        "t:within('1 s', function() return true end)"}) {
    const results::Report report = report_of(with_two_signals(
        "local n = select('#', " + std::string(call) + ") t:log(n) t:wait '5 ms'"));
    ASSERT_FALSE(report.log.empty()) << call << ": " << report.reason;
    EXPECT_EQ(report.log.back().text, "1") << call;
  }
}

TEST(Calls, AWaitForAConditionSaysWhetherItCameAndEndsWithIt) {
  const auto log = [](const std::string& lua) {
    const results::Report report =
        report_of(with_two_signals(lua + " t:expect(t:value 'x'):at_most '9 m'"));
    std::string text;
    for (const results::Note& line : report.log) text += line.text + ";";
    return text;
  };
  const std::string now = " t:log(t:now()) ";
  EXPECT_EQ(log("t:log(t:wait_until(function(s) return s.x_m > 1.0035 end, '9 ms'))" + now +
                "t:wait '5 ms'" + now),
            "true;0.004 s;0.009 s;");
  EXPECT_EQ(log("t:log(t:wait_until(function(s) return s.x_m > 2 end, '9 ms'))" + now),
            "false;0.009 s;");
  EXPECT_EQ(log("t:wait '3 ms' t:log(t:within('9 ms', function(s) return s.x_m > 1.0045 end))" +
                now + "t:wait '5 ms'" + now),
            "true;0.005 s;0.01 s;");
}

TEST(Calls, WithinCountsFromItsCallAndNamesItselfByItsPlace) {
  const results::Expectation e = only(
      with_two_signals("t:wait '30 ms'\nt:within('9 ms', function(s) return s.x_m > 1.0345 end)"));
  EXPECT_EQ(e.name, "within, plan.lua:3");
  EXPECT_EQ(e.place, "plan.lua:3");
  EXPECT_TRUE(near(e.measured, 5.0, round_off(8, 10)));
  EXPECT_TRUE(near(e.t_s, 0.035, round_off(4, 1)));
}

TEST(Calls, AnAnswerIsItsTextItsTimeAndItsName) {
  const auto ask = [](const std::string& call, int after_ms) {
    Scenario s = with_two_signals("t:wait '30 ms' local a = " + call + " t:log(a) t:log(#a)");
    s.answers["hello"] = {after_ms, "kt 5"};
    return report_of(s);
  };
  const results::Report good = ask("t:ask('hello', '^kt ')", 7);
  ASSERT_EQ(good.expectations.size(), 1u) << good.reason;
  EXPECT_EQ(good.expectations[0].name, "answer to 'hello'");
  EXPECT_EQ(good.expectations[0].note, "it said: kt 5");
  EXPECT_EQ(good.expectations[0].unit, "ms");
  EXPECT_EQ(good.expectations[0].high, 200.0);
  EXPECT_TRUE(near(good.expectations[0].measured, 7.0, round_off(8, 100)));
  EXPECT_TRUE(near(good.expectations[0].t_s, 0.037, round_off(4, 1)));
  EXPECT_EQ(good.log.at(0).text, "kt 5");
  EXPECT_EQ(good.log.at(1).text, "4");
  EXPECT_EQ(results::exit_code(ask("t:ask('hello', '^kv ')", 7)), 1);
  EXPECT_EQ(results::exit_code(ask("t:ask('hello')", 200)), 0);
  const results::Report late = ask("t:ask('hello')", 201);
  EXPECT_EQ(results::exit_code(late), 1);
  EXPECT_EQ(late.expectations.at(0).note, "no answer");
  EXPECT_EQ(late.log.at(1).text, "0");
}

// What a calibration found must not become part of a name: history and JUnit would not know it again.
TEST(Calls, AnAnswersNameHoldsNoNumberOfItsLine) {
  const auto asked = [](const std::string& line) {
    Scenario s = with_two_signals("t:wait '30 ms' t:ask('" + line + "')");
    s.answers[line] = {7, "ok"};
    return only(s);
  };
  EXPECT_EQ(asked("set gain 1.039851").name, "answer to 'set gain #'");
  EXPECT_EQ(asked("set gain 1.039851").note, "'set gain 1.039851': it said: ok");
  for (const char* number : {"-0.007678406", "3.86979e-05", "5", "nan"}) {
    EXPECT_EQ(asked(std::string("set d0 ") + number).name, "answer to 'set d0 #'") << number;
  }
}

// Each question is answered by the first line that comes after it.
TEST(Calls, EachQuestionHasItsOwnAnswer) {
  Scenario s = with_two_signals(
      "for i = 1, 3 do for _, q in ipairs { 'a', 'b' } do t:log(t:ask(q)) end end ");
  s.answers["a"] = {3, "of a"};
  s.answers["b"] = {2, "of b"};
  const results::Report report = report_of(s);
  ASSERT_EQ(report.log.size(), 6u) << report.reason;
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(report.log[i].text, i % 2 == 0 ? "of a" : "of b");
}

}  // namespace
}  // namespace whirl::oracle

// What each call of a plan refuses, tells and hands on.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/near.hpp"
#include "harness/tests/oracle/by_hand.hpp"

namespace whirl::oracle {
namespace {

struct Refused {
  const char* lua;
  const char* words;
};

TEST(PlanCalls, RefuseWhatTheyCannotUse) {
  const Refused kAll[] = {
      {"t:wait(5)", "a duration such as"},
      {"t:wait '0 s'", "shorter than a step"},
      {"t:wait '999 us'", "shorter than a step"},
      {"t:within('1 s', 3)", "a condition function(s) ... end is wanted, not a number"},
      {"t:within('1 s', function() return true end, 3)", "a name is wanted"},
      {"t:step(1)", "a step's name is wanted"},
      {"t:expect('x')", "a measurement or a number is wanted, not a string"},
      {"t:expect({ value = 1 }):at_most(2)", "a measurement or a number is wanted, not a table"},
      {"t:wait_until(function(s) t:expect(s) return true end, '5 ms')",
       "a measurement or a number is wanted, not a table"},
      {"t:expect(1, 2)", "a name is wanted"},
      {"t:expect(t:value 'x'):at_most(3)", "a length as a text is wanted, not a number"},
      {"t:expect(t:value 'x'):at_most '3 N'", "'3 N' is a force, not a length"},
      {"t:expect(1):within(3, 2)", ":within wants the lower limit first"},
      {"t:expect(1)", "t:expect(value) has no limit"},
      {"local m = t:value 'x' m.number = 7 t:expect(m):at_most '1 m'",
       "this measurement has been changed"},
      {"t:always('x'):at_most('1 m'):at_most '2 m'", "has its limit already"},
      {"t:always('c', function() return true end):at_most '1 m'",
       "a condition holds or not; it has no limit"},
      {"t:always('nothing')", "unknown signal 'nothing' (known: x, y, idle)"},
      {"t:always('x') t:wait '5 ms'", "t:always(\"x, always\") has no limit"},
      {"t:record({}, '1 s')", "a record of no signals"},
      {"local r = t:record({ 'x', 'y' }, '1 ms') r:max()",
       "a record of several signals: the signal's name is wanted"},
      {"local r = t:record({ 'x', 'y' }, '1 ms') r:max 'idle'",
       "signal 'idle' is not in this record"},
      {"local r = t:record('x', '1 ms') r:max_error { y = '1 N' }",
       "signal 'y' is not in this record"},
      {"local r = t:record({ 'x', 'y' }, '1 ms') r:max_error { x = '1 m', y = '1 N' }",
       "different dimensions"},
      {"local r = t:record('x', '1 ms') r:max_error {}",
       "a reference { signal = \"0 m\" } is wanted"},
      {"local r = t:record('x', '1 ms') r.max()", "call it with a colon"},
      {"t:budget(1)", "a function's name, \"cpu\" or \"stack\" is wanted"},
      {"t:budget 'fw::task' (1)", "a table { ... } is wanted, not a number"},
      {"t:budget 'fw::task' {}", "a budget of nothing"},
      {"t:budget 'fw::task' { period = '1 ms' }", "period and jitter go together"},
      {"t:budget 'fw::task' { jitter = '1 ms' }", "period and jitter go together"},
      {"t:budget 'fw::nobody' { execution = '1 ms' }", "'fw::nobody' is not watched"},
      {"t:budget 'fw::task' { execution = '-1 ms' }", "must not be negative"},
      {"t:budget 'fw::task' { depth = '1 KiB' }", "depth is of the stack, not of 'fw::task'"},
      {"t:budget 'stack' { depth = '1 ms' }", "depth"},
      {"t:budget 'stack' { depth = '1 KiB', during = '1 s' }", "of the whole run"},
      {"t:budget 'stack' { busy = '1 %' }", "busy is of the core, not of 'stack'"},
      {"t:budget 'cpu' { busy = '100 %' }", "busy: '100 %' must be at least 0 below 1"},
      {"t:budget 'fw::task' { share = '1000 %' }", "share: '1000 %' must be at least 0 below 1"},
      {"t:bus { device = 'nothing' }", "unknown device 'nothing' on played"},
      {"t:bus { device = 'esc1', period = '1 ms' }", "period and tolerance go together"},
      {"t:bus { device = 'esc1', direction = 'up' }", "direction"},
      {"t:latency { from = 'nobody', through = {}, to = 'esc1', at_most = '1 ms' }",
       "unknown device 'nobody'"},
      {"t:latency { from = 'imu', through = { 'fw::nobody' }, to = 'esc1', at_most = '1 ms' }",
       "is not watched"},
      {"t:latency { from = 'imu', through = {}, to = 'imu', at_most = '1 ms' }",
       "no device 'imu' on I2C or CAN"},
      {"t:fault { kind = 'gremlins' }", "unknown kind of fault 'gremlins'"},
      {"t:fault { kind = 'i2c_nack', device = 'nobody' }", "unknown device 'nobody'"},
      {"t:fault { kind = 'i2c_nack', bus = 'i2c' }", "'i2c' is no bus"},
      {"t:fault { kind = 'i2c_nack', bus = '3' }", ""},
      {"t:fault { kind = 'i2c_nack', motor = 13 }", "motor"},
      {"t:fault { kind = 'i2c_nack', motor = 0 }", "motor"},
      {"t:fault { kind = 'i2c_nack', motor = 1, bus = 'i2c3' }", "a fault has one place"},
      {"t:fault { kind = 'i2c_nack', address = 128 }", "address"},
      {"t:fault { kind = 'i2c_nack', axis = 'w' }", "axis: is of a device that senses something"},
      {"t:fault { kind = 'i2c_nack', device = 'esc1', axis = 'gyro_x' }",
       "axis: is of a device that senses something"},
      {"t:fault { kind = 'sensor_offset', device = 'imu', axis = 'field_x' }",
       "axis: 'field_x' is not known"},
      {"t:fault { kind = 'code_hangs', ['function'] = 'fw::nobody' }",
       "'fw::nobody' is not watched"},
      {"t:command { brake = '10.05 N m' }", "brake"},
      {"t:command { brake = '-10.05 N m' }", "brake"},
      {"t:command { pulses = { width = '1 ms', period = '20 ms', glitch = '1 us', glitch_after = "
       "'21 ms' } }",
       "glitch_after: beyond the period"},
      {"t:ask(1)", "a line is wanted"},
      {"t:ask 'get kt\\nget mode'", "is not one line of ASCII text"},
      {"t:ask 'caf\xC3\xA9'", "is not one line of ASCII text"},
      {"t:bus { device = 'imu', direction = 'write' }", "direction: SPI goes both ways at once"},
      {"t:bus { device = 'imu', nacks = 1 }", "nacks: SPI goes both ways at once"},
      {"t:ask('hello', 1)", "a pattern is wanted"},
      {"t:wait_until(function(s) return s.x > 1 end, '5 ms')",
       "signal 'x' is written with its unit here (write s.x_m)"},
      {"t:wait_until(function(s) return s.z_m > 1 end, '5 ms')", "unknown signal 'z_m'"},
      {"t:value('x', 'N')", "'1 N' is a force, not a length"},
      {"t:quantity 'furlong'", "furlong"},
      {"t:shortest_rise { from = '1 N', to = '2 m', current = '20 A' }", "to"},
      {"t:shortest_rise { from = '1 N', to = '2 N', current = '20 A', colour = 1 }", "colour"},
      {"t:shortest_rise { from = '1 N', to = '2 N', current = '20 A' }",
       "has no rotor of its own here"},
      {"t:command { fly = true }", "fly"},
      {"t:gust { fly = true }", "fly"},
      {"t:gust(1)", "a table { ... } is wanted"},
      {"t:latency { from = 'imu', through = {}, to = 'esc1', at_most = '1 ms', colour = 1 }",
       "colour"},
      {"t:latency { from = 'imu', through = {}, to = 'esc1', at_most = '0 ms' }", "at_most"},
      {"t:bus { device = 'esc1', bytes = -1 }", "bytes"},
      {"t:bus { device = 'esc1', nacks = -1 }", "nacks"},
      {"t:budget 'fw::task' { execution = '1 ms', colour = 1 }", "colour"},
  };
  for (const Refused& refused : kAll) {
    const results::Report report = report_of(with_two_signals(refused.lua));
    EXPECT_EQ(results::exit_code(report), 2) << refused.lua << ": " << report.reason;
    EXPECT_NE(report.reason.find(refused.words), std::string::npos)
        << refused.lua << ": " << report.reason;
    EXPECT_NE(report.reason.find("plan.lua:"), std::string::npos)
        << refused.lua << ": " << report.reason;
  }
}

io::FaultCommand sent(const std::string& lua) {
  io::FaultCommand got;
  Scenario s = with_two_signals("t:wait '10 ms' t:fault { " + lua + " } t:wait '50 ms'");
  s.on_fault = [&](const io::FaultCommand& fault) { got = fault; };
  report_of(s);
  return got;
}

TEST(PlanCalls, AFaultReachesTheBoardAsItWasAsked) {
  const io::FaultCommand nack =
      sent("kind = 'i2c_nack', device = 'esc1', start = '5 ms', duration = '20 ms', value = 3");
  EXPECT_EQ(nack.number, 1u);
  EXPECT_EQ(nack.bus, 3);
  EXPECT_EQ(nack.address, 0x2A);
  EXPECT_EQ(nack.start_ns, 15 * kMs);
  EXPECT_EQ(nack.end_ns, 35 * kMs);
  EXPECT_EQ(nack.value, 3.0);
  EXPECT_EQ(nack.axis, 0);
  const io::FaultCommand sensor = sent("kind = 'sensor_offset', device = 'imu', axis = 'gyro_y'");
  EXPECT_EQ(sensor.bus, 1);
  EXPECT_EQ(sensor.address, 0);
  EXPECT_EQ(sensor.axis, 4);
  EXPECT_EQ(sensor.start_ns, 10 * kMs);
  EXPECT_EQ(sensor.end_ns, INT64_MAX);
  EXPECT_EQ(sent("kind = 'i2c_nack', bus = 'i2c12', address = 127").bus, 12);
  EXPECT_EQ(sent("kind = 'i2c_nack', bus = 'i2c12', address = 127").address, 127);
  EXPECT_EQ(sent("kind = 'i2c_nack', motor = 4").address, 4);
  EXPECT_EQ(sent("kind = 'i2c_nack', motor = 1").address, 1);
  EXPECT_EQ(sent("kind = 'code_hangs', ['function'] = 'fw::task'").address, 1);
}

TEST(PlanCalls, AFaultsRowTellsWhenItWasAppliedAndToWhat) {
  const results::Report report =
      report_of(with_two_signals("t:wait '10 ms' t:fault { kind = 'i2c_nack', device = 'esc1', "
                                 "start = '5 ms', duration = '20 ms' }"
                                 " t:fault { kind = 'i2c_nack', bus = 'i2c3' }"
                                 " t:wait '50 ms' t:expect(t:value 'x'):at_most '9 m'"));
  ASSERT_EQ(report.faults.size(), 2u) << report.reason;
  EXPECT_EQ(report.faults[0].target, "esc1");
  EXPECT_EQ(report.faults[1].target, "i2c3");
  EXPECT_TRUE(near(report.faults[0].start_s, 0.015, round_off(4, 1)));
  EXPECT_TRUE(near(report.faults[0].end_s, 0.035, round_off(4, 1)));
  EXPECT_TRUE(near(report.faults[0].applied_s, 0.015, stated(2e-9, "within its step")));
  EXPECT_TRUE(std::isinf(report.faults[1].end_s));
  EXPECT_EQ(results::exit_code(report), 0) << report.reason;
}

TEST(PlanCalls, AnExpectationSaysWhereWhenAndOnWhatItWasMeasured) {
  const results::Expectation e =
      only(with_two_signals("t:wait '30 ms'\nlocal r = t:record('x', '20 "
                            "ms')\nt:expect(r:max()):within('1 cm', '900 cm')"));
  EXPECT_EQ(e.name, "x max");
  EXPECT_EQ(e.how, "within");
  EXPECT_EQ(e.place, "plan.lua:4");
  EXPECT_EQ(e.unit, "cm");
  EXPECT_TRUE(near(e.t_s, 0.05, round_off(4, 1)));
  EXPECT_TRUE(near(e.from_s, 0.03, round_off(4, 1)));
  EXPECT_TRUE(near(e.to_s, 0.05, round_off(4, 1)));
  EXPECT_TRUE(e.level);
  EXPECT_EQ(e.signals, std::vector<std::string>{"x"});
  ASSERT_EQ(e.limits_SI.size(), 2u);
  EXPECT_TRUE(near(e.limits_SI[0], 0.01, round_off(4, 1)));
  EXPECT_TRUE(near(*e.low, 1.0, round_off(4, 1)));
  EXPECT_TRUE(near(*e.high, 900.0, round_off(4, 900)));
  EXPECT_EQ(e.note, "");
}

TEST(PlanCalls, EveryJudgementSaysWhereInThePlanItStands) {
  const results::Report report = report_of(
      with_two_signals("t:budget 'fw::task' { period = '9 ms', jitter = '1 ms', execution = '1 "
                       "ms', response = '1 ms', latency = '1 ms' }\n"
                       "t:bus { device = 'esc1', period = '9 ms', tolerance = '1 ms' }\n"
                       "t:latency { from = 'imu', through = {}, to = 'esc1', at_most = '1 ms' }\n"
                       "t:budget 'cpu' { busy = '1 %' }\n"
                       "t:always('x'):at_most '9 m'\n"
                       "t:always('c', function() return true end)\n"
                       "t:within('1 ms', function() return true end)\n"
                       "t:ask('hello', nil, '4 ms')\n"));
  std::map<std::string, int> lines;
  for (const results::Expectation& e : report.expectations) {
    ASSERT_EQ(e.place.substr(0, 9), "plan.lua:") << e.name;
    ++lines[e.place.substr(9)];
  }
  const std::map<std::string, int> want{{"2", 4}, {"3", 2}, {"4", 1}, {"5", 1},
                                        {"6", 1}, {"7", 1}, {"8", 1}, {"9", 1}};
  EXPECT_EQ(lines, want);
  EXPECT_TRUE(near(report.expectations.back().t_s, 0.005, round_off(4, 1)));
}

TEST(PlanCalls, WithinSaysWhetherItCame) {
  EXPECT_TRUE(passes(with_two_signals(
      "t:expect(t:within('5 ms', function(s) return s.x_m > 1.0015 end, 'a') and 1 or 0):equal(1)"
      " t:expect(t:within('5 ms', function(s) return s.x_m > 0 end, 'b') and 1 or 0, "
      "'c'):equal(1)")));
  const results::Report report = report_of(with_two_signals(
      "t:expect(t:within('5 ms', function(s) return s.x_m > 9 end, 'a') and 1 or 0):equal(0)"));
  EXPECT_EQ(report.expectations.back().verdict, results::Verdict::pass);
}

TEST(PlanCalls, NotesSayWhatTheFigureDoesNot) {
  EXPECT_EQ(
      only(with_two_signals("t:within('5 ms', function(s) return s.x_m > 99 end, 'comes')")).note,
      "never came true");
  EXPECT_EQ(
      only(with_two_signals("t:within('5 ms', function(s) return s.x_m > 0 end, 'comes')")).note,
      "");
  EXPECT_EQ(only(with_two_signals("t:expect(0/0):at_most(1)")).note, "nothing to measure");
  EXPECT_EQ(only(with_two_signals("t:ask('who', nil, '5 ms')")).note, "no answer");
  const results::Expectation guard = only(
      with_two_signals("t:always('low', function(s) return s.x_m < 1.0075 end) t:wait '20 ms'"));
  EXPECT_EQ(guard.note, "first violated at 0.008000 s");
  EXPECT_TRUE(near(guard.measured, 0.013, round_off(8, 1)));
}

TEST(PlanCalls, ABudgetsNoteHasItsMiddleItsTailAndItsCount) {
  Scenario s = with_two_signals(
      "t:budget 'fw::task' { execution = '100 us', response = '1 ms' } t:wait '110 ms'");
  for (int i = 1; i <= 101; ++i) add_call(s, i * kMs, i * kMs + 500'000, (i - 1) * 500);
  const results::Report report = report_of(s);
  ASSERT_EQ(report.expectations.size(), 2u);
  EXPECT_EQ(report.expectations[0].note, "p50 25 us, p99 49.5 us, 101 values");
  EXPECT_EQ(report.expectations[1].note, "p50 0.5 ms, p99 0.5 ms, 101 values");
  EXPECT_TRUE(near(report.expectations[0].measured, 50.0, round_off(8, 50)));
  ASSERT_EQ(report.tasks.size(), 2u);
  EXPECT_EQ(report.tasks[1].calls, 101u);
  EXPECT_TRUE(near(report.tasks[1].period_mean_s, 1e-3, round_off(200, 1e-3)));
  EXPECT_TRUE(near(report.tasks[1].execution_p50_s, 25e-6, round_off(8, 1e-3)));
  EXPECT_TRUE(near(report.tasks[1].execution_max_s, 50e-6, round_off(8, 1e-3)));
  EXPECT_TRUE(near(report.tasks[1].response_max_s, 500e-6, round_off(8, 1e-3)));
  EXPECT_TRUE(near(report.tasks[1].latency_max_s, 500e-9, round_off(8, 1e-3)));
  EXPECT_EQ(report.tasks[0].calls, 0u);
}

TEST(PlanCalls, WhatNoInterruptCallsHasNoLatencyInTheTable) {
  Scenario s = with_two_signals("t:expect(t:value 'x'):at_most '9 m' t:wait '9 ms'");
  add_call(s, kMs, 2 * kMs, 1000, -1);
  EXPECT_TRUE(std::isnan(report_of(s).tasks.at(1).latency_max_s));
  add_call(s, 3 * kMs, 4 * kMs, 1000, 0);
  EXPECT_EQ(report_of(s).tasks.at(1).latency_max_s, 0.0);
}

TEST(PlanCalls, AWriteThatEndsWithItsWindowBelongsToIt) {
  Scenario s = with_two_signals(
      "t:latency { from = 'imu', through = {}, to = 'esc1', at_most = '9 ms', during = '5 ms' } "
      "t:wait '9 ms'");
  s.messages.push_back(
      {100'000, [](io::Batch& batch) { batch.add(io::Kind::data_ready, 0, 100'000, nullptr, 0); }});
  s.messages.push_back({5 * kMs, [](io::Batch& batch) {
                          batch.add(io::Kind::i2c_transaction, 3, 5 * kMs,
                                    io::BusTransaction{4 * kMs, 0x2A, 0, 1, 0});
                        }});
  EXPECT_TRUE(near(only(s).measured, 4.9, round_off(8, 5)));
}

TEST(PlanCalls, AValueInAUnitIsAPlainNumberAndAQuantityItsNumberInSI) {
  EXPECT_TRUE(near(only(with_two_signals("t:expect(t:value('x', 'cm')):at_most(900)")).measured,
                   100.0, round_off(4, 100)));
  EXPECT_TRUE(near(only(with_two_signals("t:expect(t:quantity '5 cm'):at_most(900)")).measured,
                   0.05, round_off(4, 1)));
  EXPECT_EQ(only(with_two_signals("t:wait '7 ms' t:expect(t:now()):at_most '9 ms'")).measured, 7.0);
}

TEST(PlanCalls, ARunsStepsAndWordsAreKeptWithTheirTimes) {
  Scenario s = with_two_signals("t:wait '7 ms' t:step 'up' t:log('height', 1) t:wait '1 s'");
  s.timeout_ms = 50;
  const results::Report report = report_of(s);
  ASSERT_EQ(report.steps.size(), 1u);
  EXPECT_EQ(report.steps[0].text, "up");
  EXPECT_TRUE(near(report.steps[0].t_s, 0.007, round_off(4, 1)));
  ASSERT_EQ(report.log.size(), 1u);
  EXPECT_TRUE(near(report.log[0].t_s, 0.007, round_off(4, 1)));
  EXPECT_NE(report.reason.find("still waiting in step 'up' at the plan's timeout"),
            std::string::npos)
      << report.reason;
  EXPECT_TRUE(near(report.virtual_s, 0.05, round_off(4, 1)));
}

}  // namespace
}  // namespace whirl::oracle

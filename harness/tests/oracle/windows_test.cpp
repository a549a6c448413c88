// Windows on timing: which calls and transactions belong to one, what is told of them, which devices they
// can speak of.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "harness/tests/oracle/by_hand.hpp"

namespace whirl::oracle {
namespace {

constexpr std::int64_t kUs = 1000;

void add_transfer(Scenario& s, std::int64_t start_ns, std::int64_t stop_ns, io::BusTransaction what,
                  std::uint16_t bus = 3, io::Kind kind = io::Kind::i2c_transaction) {
  what.start_ns = start_ns;
  s.messages.push_back({stop_ns, [=](io::Batch& batch) { batch.add(kind, bus, stop_ns, what); }});
}

// esc1 is at 0x2A on I2C 3. A write of three bytes that was acknowledged.
const io::BusTransaction kWrite{0, 0x2A, 0, 1, 3};

TEST(Windows, NoOtherTrafficIsCounted) {
  Scenario s = with_two_signals(
      "t:bus { device = 'esc1', direction = 'write', bytes = 3, nacks = 0, during = '20 ms' } "
      "t:wait "
      "'50 ms'");
  add_transfer(s, 5 * kMs, 6 * kMs, kWrite);
  EXPECT_EQ(only(s).note, "1 transactions");
  EXPECT_EQ(only(s).name, "esc1 write NACKs");
  EXPECT_EQ(only(s).measured, 0.0);
  EXPECT_EQ(only(s).unit, "");
  add_transfer(s, 7 * kMs, 8 * kMs, {0, 0x29, 0, 0, 3});     // of another device
  add_transfer(s, 7 * kMs, 8 * kMs, {0, 0x2A, 1, 0, 3});     // a read
  add_transfer(s, 7 * kMs, 8 * kMs, {0, 0x2A, 0, 0, 2});     // of another length
  add_transfer(s, 7 * kMs, 8 * kMs, {0, 0x2A, 0, 0, 3}, 2);  // on another bus
  add_transfer(s, 7 * kMs, 8 * kMs, {0, 0x2A, 0, 0, 3}, 3, io::Kind::spi_transaction);
  add_transfer(s, 20 * kMs + 1, 22 * kMs, {0, 0x2A, 0, 0, 3});  // behind the window
  EXPECT_EQ(only(s).note, "1 transactions");
  EXPECT_EQ(only(s).measured, 0.0);
  add_transfer(s, 20 * kMs, 22 * kMs, {0, 0x2A, 0, 0, 3});  // begins with its last moment
  EXPECT_EQ(only(s).note, "2 transactions");
  EXPECT_EQ(only(s).measured, 1.0);
}

TEST(Windows, BeginWithTheirCall) {
  for (std::int64_t early : {0, 1}) {
    Scenario s = with_two_signals("t:wait '10 ms' t:bus { device = 'esc1' } t:wait '20 ms'");
    add_transfer(s, 10 * kMs - early, 12 * kMs, kWrite);
    add_transfer(s, 15 * kMs, 16 * kMs, {0, 0x2A, 1, 1, 9});  // any direction, any length
    EXPECT_EQ(only(s).note, early == 0 ? "2 transactions" : "1 transactions");
    EXPECT_EQ(only(s).name, "esc1 NACKs");
  }
}

TEST(Windows, OneByteIsALengthToo) {
  Scenario s = with_two_signals("t:bus { device = 'esc1', bytes = 1, nacks = 1 } t:wait '20 ms'");
  add_transfer(s, 5 * kMs, 6 * kMs, {0, 0x2A, 0, 0, 1});
  add_transfer(s, 7 * kMs, 8 * kMs, {0, 0x2A, 0, 0, 2});
  EXPECT_EQ(only(s).measured, 1.0);
  EXPECT_EQ(only(s).verdict, results::Verdict::pass);
  add_transfer(s, 9 * kMs, 10 * kMs, {0, 0x2A, 0, 0, 1});
  EXPECT_EQ(only(s).verdict, results::Verdict::fail);
}

TEST(Windows, ABusWithoutTrafficHasNoCountOfItsRefusals) {
  const results::Expectation e = only(
      with_two_signals("t:bus { device = 'esc1', direction = 'read', nacks = 9 } t:wait '9 ms'"));
  EXPECT_EQ(e.name, "esc1 read NACKs");
  EXPECT_EQ(e.verdict, results::Verdict::fail);
  EXPECT_TRUE(std::isnan(e.measured));
  EXPECT_EQ(e.note, "0 transactions");
}

TEST(Windows, ASpiBusHasPeriodsAndNoAcknowledge) {
  Scenario s = with_two_signals(
      "t:bus { device = 'imu', period = '5 ms', tolerance = '1 ms', during = '20 ms' } t:wait '30 "
      "ms'");
  for (std::int64_t t = 4 * kMs; t < 30 * kMs; t += 5 * kMs) {
    add_transfer(s, t, t + kMs, {0, 0, 1, 1, 15}, 1, io::Kind::spi_transaction);
    add_transfer(s, t + kMs, t + 2 * kMs, {0, 1, 1, 1, 15}, 1, io::Kind::spi_transaction);
  }
  const results::Expectation e = only(s);
  EXPECT_EQ(e.name, "imu period deviation");
  EXPECT_EQ(e.measured, 0.0);
  EXPECT_EQ(e.note, "p50 0 ms, p99 0 ms, 3 values");
}

// Entries at 5, 10, 15, 20 ms; the gaps at the ends of the window are as long as a period, or longer.
TEST(Windows, AGapAtEitherEndCountsWhereItIsLongerThanAPeriod) {
  const auto jitter = [](const std::string& wait, const std::string& during) {
    Scenario s = with_two_signals(
        "t:wait '" + wait + "' t:budget 'fw::task' { period = '5 ms', jitter = '1 us', during = '" +
        during + "' } t:wait '50 ms'");
    for (int i = 1; i <= 4; ++i) add_call(s, i * 5 * kMs, i * 5 * kMs + 100 * kUs);
    return only(s);
  };
  // Whole gaps of one period at both ends: 3 periods between 4 calls, and nothing else.
  const results::Expectation whole = jitter("5 ms", "20 ms");
  EXPECT_EQ(whole.note, "p50 0 us, p99 0 us, 3 values");
  EXPECT_TRUE(near(whole.measured, 0.0, round_off(8, 5000)));
  EXPECT_EQ(jitter("4 ms", "17 ms").note, "p50 0 us, p99 0 us, 3 values");
  // Calls at both edges belong to it, that at its end although it still runs then.
  EXPECT_EQ(jitter("5 ms", "15 ms").note, "p50 0 us, p99 0 us, 3 values");
  const results::Expectation tail = jitter("5 ms", "23 ms");
  EXPECT_TRUE(near(tail.measured, 3000.0, round_off(8, 5000)));
  EXPECT_EQ(tail.note, "p50 0 us, p99 2910 us, 4 values");
  // From 11 ms on: a head of 4 ms, one period, a tail of 1 ms.
  EXPECT_EQ(jitter("11 ms", "10 ms").note, "p50 0 us, p99 0 us, 1 values");
  const results::Expectation none = jitter("21 ms", "12 ms");
  EXPECT_TRUE(near(none.measured, 7000.0, round_off(8, 9000)));
  EXPECT_EQ(none.note, "p50 7000 us, p99 7000 us, 2 values");
}

// A gap of all the window that is within the tolerance was a pass for what never came.
TEST(Windows, WhatNeverCameIsNoPassHoweverWideItsTolerance) {
  for (const char* window :
       {"t:budget 'fw::task' { period = '1 ms', jitter = '20 ms', during = '20 ms' }",
        "t:budget 'fw::task' { period = '1 ms', jitter = '19 ms', during = '20 ms' }",
        "t:bus { device = 'imu', period = '1 s', tolerance = '2 s', during = '20 ms' }"}) {
    const results::Expectation e = only(with_two_signals(std::string(window) + " t:wait '30 ms'"));
    EXPECT_EQ(e.verdict, results::Verdict::fail) << window;
    EXPECT_EQ(e.note, "nothing to measure") << window;
  }
  Scenario once = with_two_signals(
      "t:budget 'fw::task' { period = '1 ms', jitter = '20 ms', during = '20 ms' } t:wait '30 ms'");
  add_call(once, 5 * kMs, 6 * kMs);
  EXPECT_EQ(only(once).verdict, results::Verdict::pass);
  EXPECT_EQ(results::exit_code(report_of(with_two_signals(
                "t:budget 'fw::task' { period = '0 s', jitter = '1 s' } t:wait '9 ms'"))),
            2);
}

// 60'000'000 * 1e-9 is not 60 * 1e-3: the difference is no deviation.
TEST(Windows, RoundingIsNoDeviation) {
  Scenario s = with_two_signals(
      "t:budget 'fw::task' { period = '60 ms', jitter = '0 us', during = '180 ms' } t:wait '180 "
      "ms'");
  for (int i = 1; i <= 3; ++i) add_call(s, i * 60 * kMs, i * 60 * kMs + kMs);
  EXPECT_EQ(only(s).note.find("p50 0 us, p99 0 us, "), 0u) << only(s).note;
  EXPECT_EQ(only(s).verdict, results::Verdict::pass);
}

TEST(Windows, AHeadIsFromTheWindowsBeginToTheFirstCall) {
  Scenario s = with_two_signals(
      "t:wait '10 ms' t:budget 'fw::task' { period = '5 ms', jitter = '1 us', during = '12 ms' } "
      "t:wait "
      "'50 ms'");
  add_call(s, 19 * kMs, 20 * kMs);
  const results::Expectation e = only(s);
  EXPECT_TRUE(near(e.measured, 4000.0, round_off(8, 9000)));
  EXPECT_EQ(e.note, "p50 4000 us, p99 4000 us, 1 values");
}

TEST(Windows, ACallBelongsToThemByItsEntryAndItsReturn) {
  const auto note = [](std::int64_t entry_ns, std::int64_t return_ns) {
    Scenario s = with_two_signals(
        "t:wait '10 ms' t:budget 'fw::task' { execution = '1 s', during = '20 ms' } t:wait '50 "
        "ms'");
    add_call(s, entry_ns, return_ns, 1500);
    return only(s).note;
  };
  const std::string one = "p50 1.5e-06 s, p99 1.5e-06 s, 1 values", none = "nothing to measure";
  EXPECT_EQ(note(10 * kMs, 11 * kMs), one);
  EXPECT_EQ(note(10 * kMs - 1, 11 * kMs), none);
  EXPECT_EQ(note(29 * kMs, 30 * kMs), one);
  EXPECT_EQ(note(29 * kMs, 30 * kMs + 1), none);
}

TEST(Windows, EachBudgetOfAFunctionHasItsOwnFigure) {
  Scenario s = with_two_signals(
      "t:budget 'fw::task' { execution = '9 us', response = '9 ms', latency = '9 us' } t:wait '30 "
      "ms'");
  add_call(s, 5 * kMs, 7 * kMs, 3000, 0);
  add_call(s, 9 * kMs, 10 * kMs, 2000, 400);
  const results::Report report = report_of(s);
  ASSERT_EQ(report.expectations.size(), 3u) << report.reason;
  EXPECT_EQ(report.expectations[0].name, "fw::task execution time");
  EXPECT_TRUE(near(report.expectations[0].measured, 3.0, round_off(8, 10)));
  EXPECT_EQ(report.expectations[1].name, "fw::task response time");
  EXPECT_TRUE(near(report.expectations[1].measured, 2.0, round_off(8, 10)));
  EXPECT_EQ(report.expectations[2].name, "fw::task interrupt latency");
  EXPECT_TRUE(near(report.expectations[2].measured, 0.4, round_off(8, 10)));
  EXPECT_EQ(report.expectations[2].note, "p50 0.2 us, p99 0.396 us, 2 values");
  add_call(s, 15 * kMs, 16 * kMs, 2000, -1);
  EXPECT_EQ(report_of(s).expectations[2].note, "not known of each of 3 values");
  EXPECT_EQ(report_of(s).expectations[2].verdict, results::Verdict::fail);
}

// It comes twice, and hangs in the third call.
TEST(Windows, AFunctionThatHangsMeetsNoLimit) {
  const auto hangs = [](const std::string& budget) {
    Scenario s = with_two_signals("t:budget 'fw::task' { " + budget + " } t:wait '30 ms'");
    for (std::int64_t t : {5, 6}) add_call(s, t * kMs, t * kMs + 100 * kUs, 90 * kUs);
    s.messages.push_back(
        {30 * kMs, [](io::Batch& batch) {
           batch.add(io::Kind::function_call, 1, 30 * kMs, io::FunctionCall{7 * kMs, -1, -1});
         }});
    return only(s);
  };
  const results::Expectation response = hangs("response = '200 us', during = '20 ms'");
  EXPECT_EQ(response.verdict, results::Verdict::fail);
  EXPECT_TRUE(near(response.measured, 13'000.0, round_off(8, 1e4)));
  for (const char* budget :
       {"execution = '100 us', during = '20 ms'", "share = '5 %', during = '20 ms'"}) {
    EXPECT_EQ(hangs(budget).verdict, results::Verdict::inconclusive) << budget;
    EXPECT_NE(hangs(budget).note.find("returned"), std::string::npos) << hangs(budget).note;
  }
  EXPECT_EQ(hangs("execution = '100 us', during = '7 ms'").verdict,
            results::Verdict::pass);  // it had just begun
}

// It returns behind the window's end, and is known then.
TEST(Windows, ACallThatAWindowCutsCountsByWhatIsKnownOfIt) {
  const auto verdict = [](const std::string& budget) {
    Scenario s =
        with_two_signals("t:budget 'fw::task' { " + budget + ", during = '20 ms' } t:wait '30 ms'");
    add_call(s, 5 * kMs, 5 * kMs + 100 * kUs, 90 * kUs);
    add_call(s, 19 * kMs, 23 * kMs, 500 * kUs);
    return only(s).verdict;
  };
  EXPECT_EQ(verdict("response = '999 us'"), results::Verdict::fail);
  EXPECT_EQ(verdict("response = '1001 us'"), results::Verdict::pass);
  EXPECT_EQ(verdict("execution = '499 us'"), results::Verdict::fail);
  EXPECT_EQ(verdict("execution = '501 us'"), results::Verdict::pass);
}

TEST(Windows, TheFirstFunctionOfTheListIsWatchedToo) {
  Scenario s = with_two_signals("t:budget 'fw::none' { execution = '1 s' } t:wait '20 ms'");
  s.messages.push_back(
      {2 * kMs, [](io::Batch& batch) {
         batch.add(io::Kind::function_call, 0, 2 * kMs, io::FunctionCall{1 * kMs, 1000, 500});
       }});
  EXPECT_EQ(only(s).name, "fw::none execution time");
  EXPECT_TRUE(near(only(s).measured, 1e-6, round_off(8, 1e-6)));
}

TEST(Windows, ABudgetMayBeOfNothing) {
  EXPECT_EQ(only(with_two_signals("t:budget 'fw::task' { execution = '0 us' } t:wait '9 ms'")).high,
            0.0);
}

TEST(Windows, BusyIsTheShareOfThePiecesInThem) {
  Scenario s =
      with_two_signals("t:budget 'cpu' { busy = '50 %', during = '20 ms' } t:wait '40 ms'");
  for (std::int64_t t : {0, 10, 20}) {
    s.messages.push_back({(t + 10) * kMs, [=](io::Batch& batch) {
                            batch.add(io::Kind::busy_time, 0, (t + 10) * kMs,
                                      io::BusyTime{t * kMs, t == 20 ? 10 * kMs : 2 * kMs});
                          }});
  }
  const results::Expectation e = only(s);
  EXPECT_EQ(e.name, "CPU busy share");
  EXPECT_TRUE(near(e.measured, 20.0, round_off(8, 100)));
  EXPECT_TRUE(near(e.t_s, 0.02, round_off(4, 1)));
  EXPECT_EQ(e.note, "");
}

// Data ready at 1 ms, a write from 4 to 5 ms to each of two motors and to a part that is none.
Scenario with_motors(const std::string& to, const std::string& more = "") {
  Scenario s = with_two_signals("t:latency { from = 'imu', through = {}, to = '" + to +
                                "', at_most = '4500 us'" + more + " } t:wait '20 ms'");
  s.other_devices = {{"m1", "i2c3", 0x40, 1},
                     {"m2", "i2c2", 0x41, 2},
                     {"part", "i2c3", 0x42, 0},
                     {"m3", "usart2", -1, 3}};
  s.messages.push_back(
      {1 * kMs, [](io::Batch& batch) { batch.add(io::Kind::data_ready, 0, 1 * kMs, nullptr, 0); }});
  add_transfer(s, 4 * kMs, 5 * kMs, {0, 0x40, 0, 1, 2}, 3);
  add_transfer(s, 4 * kMs, 5'200 * kUs, {0, 0x41, 0, 1, 2}, 2);
  add_transfer(s, 4 * kMs, 9 * kMs, {0, 0x42, 0, 1, 2}, 3);
  add_transfer(s, 8 * kMs, 9 * kMs, {0, 0x40, 1, 1, 2}, 3);                             // a read
  add_transfer(s, 8 * kMs, 9 * kMs, {0, 0x40, 0, 1, 2}, 1);                             // elsewhere
  add_transfer(s, 8 * kMs, 9 * kMs, {0, 0x40, 0, 1, 2}, 3, io::Kind::spi_transaction);  // no I2C
  return s;
}

TEST(Windows, ALatencyIsToTheDeviceThatIsNamedOrToEveryMotor) {
  const results::Report all = report_of(with_motors("esc"));
  ASSERT_EQ(all.expectations.size(), 1u) << all.reason;
  EXPECT_EQ(all.expectations[0].name, "imu to esc latency");
  EXPECT_EQ(all.expectations[0].note, "p50 4100 us, p99 4198 us, 2 values");
  EXPECT_TRUE(near(all.expectations[0].measured, 4200.0, round_off(8, 9000)));
  ASSERT_EQ(all.histograms.size(), 1u);
  EXPECT_EQ(all.histograms[0].name, "imu to esc latency");
  EXPECT_EQ(all.histograms[0].unit, "s");
  EXPECT_EQ(all.histograms[0].samples.size(), 2u);
  EXPECT_TRUE(near(all.histograms[0].limit, 4.5e-3, round_off(8, 1e-2)));
  EXPECT_TRUE(near(only(with_motors("m1")).measured, 4000.0, round_off(8, 9000)));
  EXPECT_TRUE(near(only(with_motors("part")).measured, 8000.0, round_off(8, 9000)));
  EXPECT_EQ(only(with_motors("part")).verdict, results::Verdict::fail);
}

TEST(Windows, AMotorThatNobodyWroteToHasNoLatency) {
  Scenario s = with_motors("esc");
  s.other_devices.push_back({"m4", "i2c3", 0x43, 4});
  const results::Expectation e = only(s);
  EXPECT_EQ(e.verdict, results::Verdict::fail);
  EXPECT_TRUE(std::isnan(e.measured));
  EXPECT_EQ(e.note, "p50 4100 us, p99 4198 us, 2 values; nothing traced to 1 of 3 actuators");
}

TEST(Windows, AWriteBelongsToALatencyFromItsStartToItsStop) {
  const auto note = [](const std::string& wait, const std::string& during) {
    Scenario s = with_motors("m1", ", during = '" + during + "'");
    s.lua = "t:wait '" + wait + "' " + s.lua;
    return only(s).note;
  };
  EXPECT_EQ(note("4 ms", "1 ms"), "p50 4000 us, p99 4000 us, 1 values");
  EXPECT_EQ(note("5 ms", "9 ms"), "nothing to measure");
  EXPECT_EQ(note("1 ms", "3 ms"), "nothing to measure");
}

TEST(Windows, AWriteThatCannotBeTracedIsNoPass) {
  Scenario s = with_motors("m1");
  add_transfer(s, 500 * kUs, 600 * kUs, {0, 0x40, 0, 1, 2}, 3);
  const results::Expectation e = only(s);
  EXPECT_EQ(e.verdict, results::Verdict::fail);
  EXPECT_EQ(e.note, "p50 4000 us, p99 4000 us, 1 values; 1 writes cannot be traced to a sample");
  EXPECT_TRUE(std::isnan(e.measured));
}

TEST(Windows, ALatencyGoesThroughTheTasksThatAreNamed) {
  Scenario s = with_two_signals(
      "t:latency { from = 'imu', through = { 'fw::none', 'fw::task' }, to = 'esc1', at_most = '9 "
      "ms' } "
      "t:wait '20 ms'");
  for (std::int64_t t : {1, 3}) {
    s.messages.push_back({t * kMs, [=](io::Batch& batch) {
                            batch.add(io::Kind::data_ready, 0, t * kMs, nullptr, 0);
                          }});
  }
  s.messages.push_back(
      {2 * kMs, [](io::Batch& batch) {
         batch.add(io::Kind::function_call, 0, 2 * kMs, io::FunctionCall{1'500 * kUs, 1000, 500});
       }});
  add_call(s, 3'500 * kUs, 5 * kMs);
  add_transfer(s, 4 * kMs, 6 * kMs, {0, 0x2A, 0, 1, 3});
  EXPECT_TRUE(near(only(s).measured, 5.0, round_off(8, 10)));  // from 1 ms, not from 3 ms
}

TEST(Windows, ATaskThatNeverRanLedToNoWrite) {
  Scenario s = with_two_signals(
      "t:latency { from = 'imu', through = { 'fw::none' }, to = 'esc1', at_most = '9 ms' } t:wait "
      "'20 "
      "ms'");
  s.messages.push_back(
      {1 * kMs, [](io::Batch& batch) { batch.add(io::Kind::data_ready, 0, 1 * kMs, nullptr, 0); }});
  add_transfer(s, 4 * kMs, 6 * kMs, {0, 0x2A, 0, 1, 3});
  EXPECT_EQ(only(s).note, "nothing to measure; 1 writes cannot be traced to a sample");
  EXPECT_EQ(only(s).verdict, results::Verdict::fail);
}

struct Refused {
  const char *lua, *words;
};

TEST(Windows, RefuseDevicesThatAreOnNoBusOfTheirs) {
  const Refused kAll[] = {
      {"t:bus { device = 'radio' }", "radio is on usart2, not I2C or SPI"},
      {"t:bus { device = 'odd' }", "odd is on 'i2cx', which is no bus"},
      {"t:fault { kind = 'i2c_nack', device = 'odd' }", "'i2cx' is no bus"},
      {"t:latency { from = 'imu', through = {}, to = 'radio', at_most = '1 ms' }",
       "no device 'radio' on I2C or CAN of played"},
      {"t:latency { from = 'imu', through = {}, to = 'odd', at_most = '1 ms' }",
       "odd is on 'i2cx', which is no bus"},
      {"t:latency { from = 'imu', through = {}, to = 'esc', at_most = '1 ms' }",
       "no device 'esc' on I2C or CAN of played"},
      {"t:fault { kind = 'i2c_nack', address = -1 }", "address"},
  };
  for (const Refused& refused : kAll) {
    Scenario s = with_two_signals(refused.lua);
    s.other_devices = {{"radio", "usart2"}, {"odd", "i2cx"}};
    const results::Report report = report_of(s);
    EXPECT_EQ(results::exit_code(report), 2) << refused.lua;
    EXPECT_NE(report.reason.find(refused.words), std::string::npos) << report.reason;
    EXPECT_NE(report.reason.find("plan.lua:2"), std::string::npos) << report.reason;
  }
}

TEST(Windows, AFaultNamesWhatItIsAimedAt) {
  const results::Report report = report_of(
      with_two_signals("t:fault { kind = 'code_hangs', ['function'] = 'fw::none', start = '1 s' }"
                       " t:fault { kind = 'i2c_nack', address = 0, bus = 'i2c3' }"
                       " t:expect(t:value 'x'):at_most '9 m' t:wait '20 ms'"));
  ASSERT_EQ(report.faults.size(), 2u) << report.reason;
  EXPECT_EQ(report.faults[0].target, "fw::none");
  EXPECT_LT(report.faults[0].applied_s, 0.0);
  EXPECT_EQ(report.faults[1].target, "i2c3");
  EXPECT_EQ(report.faults[1].kind, "i2c_nack");
}

}  // namespace
}  // namespace whirl::oracle

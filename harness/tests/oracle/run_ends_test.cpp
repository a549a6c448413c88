// How a run begins and ends: what counts as an act of the firmware, which end is whose fault and in which
// words, and what the report keeps of it.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "base/interruption.hpp"
#include "base/near.hpp"
#include "harness/tests/oracle/by_hand.hpp"
#include "io_bridges/devices/faults.hpp"

namespace whirl::oracle {
namespace {

constexpr const char* kLooks = "t:wait '20 ms' t:expect(t:value 'x'):at_most '9 m'";

// A target that tells of one message only.
Scenario telling(io::Kind kind, const std::string& lua = kLooks) {
  Scenario s = with_two_signals(lua);
  s.messages = {{5 * kMs, [kind](io::Batch& batch) {
                   const std::uint8_t nothing[64] = {};
                   batch.add(kind, 0, 5 * kMs, nothing, sizeof nothing);
                 }}};
  return s;
}

TEST(RunEnds, OnlyWhatAnImageBringsAboutShowsThatItRuns) {
  for (io::Kind kind : {io::Kind::i2c_transaction, io::Kind::spi_transaction,
                        io::Kind::uart_received, io::Kind::function_call, io::Kind::esc_setpoint,
                        io::Kind::interrupt_latency, io::Kind::i2c_reply}) {
    EXPECT_EQ(report_of(telling(kind)).verdict, results::Verdict::pass) << static_cast<int>(kind);
  }
  for (io::Kind kind : {io::Kind::data_ready, io::Kind::finding, io::Kind::fault_applied,
                        io::Kind::clock_setup, io::Kind::busy_time, io::Kind::shaft_state,
                        io::Kind::uart_delivered, io::Kind::board_reset}) {
    EXPECT_EQ(
        report_of(telling(kind)).reason,
        "the image was never seen to run: no byte on a bus, no call of a watched function, no "
        "interrupt served")
        << static_cast<int>(kind);
  }
}

TEST(RunEnds, WhatWasSeenToRunOnceHasRun) {
  Scenario s = telling(io::Kind::uart_received);
  s.messages.push_back(
      {5 * kMs, [](io::Batch& batch) { batch.add(io::Kind::data_ready, 0, 5 * kMs, nullptr, 0); }});
  s.messages.push_back(
      {9 * kMs, [](io::Batch& batch) { batch.add(io::Kind::data_ready, 0, 9 * kMs, nullptr, 0); }});
  EXPECT_EQ(report_of(s).reason, "");
}

TEST(RunEnds, APlanThatReadsNothingAssertsNothing) {
  EXPECT_EQ(
      report_of(with_two_signals("t:wait '20 ms' t:expect(1):at_most(2)")).reason,
      "the plan asserts nothing about the running image: it reads no signal, no answer and no "
      "window");
}

struct Ended {
  Ending how;
  const char* reason;
  const char* expectation;  // that the end brings with it
  const char* note;
};

TEST(RunEnds, EachEndOfTheFirmwareFailsByItsName) {
  const Ended kAll[] = {
      {Ending::core_fault, "firmware fault: HardFault in fw::wrong+0x4 at 0x08001234",
       "the firmware runs without a fault", "HardFault in fw::wrong+0x4 at 0x08001234"},
      {Ending::watchdog, "firmware fault: reset by the independent watchdog",
       "the firmware keeps its watchdogs fed", "reset by the independent watchdog"},
      {Ending::locks_up, "the core locked up", "the firmware runs to the end of the plan",
       "the core locked up"},
      {Ending::switches_off, "the board switched itself off",
       "the firmware runs to the end of the plan", "the board switched itself off"},
  };
  for (const Ended& ended : kAll) {
    Scenario s = with_two_signals(kLooks);
    s.ending = ended.how;
    s.ending_ms = 12;
    const results::Report report = report_of(s);
    EXPECT_EQ(results::exit_code(report), 1);
    EXPECT_EQ(report.reason, ended.reason);
    ASSERT_EQ(report.expectations.size(), 1u) << ended.reason;
    const results::Expectation& e = report.expectations[0];
    EXPECT_EQ(e.name, ended.expectation);
    EXPECT_EQ(e.note, ended.note);
    EXPECT_EQ(e.how, "holds");
    EXPECT_EQ(e.verdict, results::Verdict::fail);
    EXPECT_EQ(e.place, "plan.lua:1");
    EXPECT_TRUE(std::isnan(e.measured));
    EXPECT_TRUE(std::isnan(e.margin));
    EXPECT_TRUE(near(e.t_s, 0.012, round_off(4, 1)));
    EXPECT_TRUE(near(report.virtual_s, 0.012, round_off(4, 1)));
    EXPECT_EQ(report.cpu_faults.size(), ended.how == Ending::core_fault ? 1u : 0u);
  }
}

TEST(RunEnds, ATimeoutSaysItsLimitAndWhereThePlanStood) {
  const auto reason = [](int timeout_ms, const std::string& before) {
    Scenario s = with_two_signals(before + " t:wait '1 min'");
    s.timeout_ms = timeout_ms;
    const results::Report report = report_of(s);
    EXPECT_EQ(report.expectations.size(), 1u);
    EXPECT_EQ(report.expectations[0].name, "plan ends before its timeout");
    return report.reason + " | " + report.expectations[0].note;
  };
  EXPECT_EQ(reason(50, ""),
            "still waiting at the plan's timeout of 0.05 s virtual time | still waiting");
  EXPECT_EQ(
      reason(2000, "t:step 'up'"),
      "still waiting in step 'up' at the plan's timeout of 2 s virtual time | still waiting in "
      "step 'up'");
}

TEST(RunEnds, WordsOfTheTargetAtItsStopStillCount) {
  Scenario s = with_two_signals(kLooks);
  s.last_words = [](io::Batch& rest) {
    io::CpuFault fault;
    fault.exception = 3;
    rest.add(io::Kind::cpu_fault, 0, 20 * kMs, fault, "main", 4);
    const std::string words("IWDG\0is not fed", 15);
    rest.add(io::Kind::finding, 0, 3 * kMs, words.data(), 15);
    rest.add(io::Kind::statistics, 0, 20 * kMs, "{}", 2);
    rest.add(io::Kind::clock_setup, 0, 2 * kMs, io::ClockSetup{16e6, 16e6, 16e6, 16e6});
  };
  const results::Report report = report_of(s);
  EXPECT_EQ(results::exit_code(report), 1);
  EXPECT_EQ(report.reason, "firmware fault: HardFault in main at 0x00000000");
  EXPECT_EQ(report.cpu_faults.size(), 1u);
  EXPECT_EQ(report.statistics_json, "{}");
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].who, "IWDG");
  EXPECT_EQ(report.findings[0].text, "is not fed");
  EXPECT_TRUE(near(report.findings[0].t_s, 0.003, round_off(4, 1)));
  ASSERT_EQ(report.log.size(), 1u);
  EXPECT_EQ(report.log[0].who, "RCC");
}

TEST(RunEnds, OneFaultIsToldOnce) {
  Scenario s = with_two_signals(kLooks);
  s.ending = Ending::core_fault;
  s.ending_ms = 12;
  s.last_words = [](io::Batch& rest) {
    rest.add(io::Kind::board_reset, io::kResetByWindowWatchdog, 13 * kMs, nullptr, 0);
  };
  const results::Report report = report_of(s);
  EXPECT_EQ(report.reasons.size(), 1u);
  EXPECT_EQ(report.cpu_faults.size(), 1u);
  EXPECT_EQ(report.expectations.size(), 1u);
}

// A reset that is no watchdog's is the firmware's own affair.
TEST(RunEnds, OnlyAWatchdogsResetFails) {
  const auto reason = [](std::uint16_t cause) {
    Scenario s = with_two_signals(kLooks);
    s.messages.push_back({5 * kMs, [cause](io::Batch& batch) {
                            batch.add(io::Kind::board_reset, cause, 5 * kMs, nullptr, 0);
                          }});
    return report_of(s).reason;
  };
  EXPECT_EQ(reason(io::kResetByWindowWatchdog), "firmware fault: reset by the window watchdog");
  EXPECT_EQ(reason(io::kResetByIndependentWatchdog),
            "firmware fault: reset by the independent watchdog");
  for (std::uint16_t other : {0, 1, 2, 5}) EXPECT_EQ(reason(other), "") << other;
}

// The user's signal ends the target too, so that its complaint is the lesser reason.
TEST(RunEnds, AnInterruptionIsNotBlamedOnTheTargetThatItEnds) {
  for (Ending ending : {Ending::returns, Ending::lost_target}) {
    Scenario s = with_two_signals("t:wait '10 ms' t:fault { kind = 'i2c_nack', bus = 'i2c3' }" +
                                  std::string(kLooks));
    s.on_fault = [](const io::FaultCommand&) { pretend_interruption(15); };
    s.ending = ending;
    s.ending_ms = 11;
    const results::Report report = report_of(s);
    pretend_interruption(0);
    EXPECT_EQ(report.reason, "interrupted by signal TERM");
    EXPECT_EQ(results::exit_code(report), 3);
    EXPECT_TRUE(near(report.virtual_s, ending == Ending::returns ? 0.011 : 0.010, round_off(4, 1)));
  }
}

TEST(RunEnds, AFaultThatTheWorldAppliesAtTheVeryStartIsApplied) {
  Scenario s = with_two_signals(std::string("t:fault { kind = 'dip' } ") + kLooks);
  s.world_faults = {{"dip", true}};
  const results::Report report = report_of(s);
  EXPECT_EQ(report.reason, "");
  ASSERT_EQ(report.faults.size(), 1u);
  EXPECT_EQ(report.faults[0].applied_s, 0.0);
  s.world_faults = {{"dip", false}};
  EXPECT_NE(report_of(s).reason.find("fault dip on  was applied by nobody"), std::string::npos)
      << report_of(s).reason;
  EXPECT_LT(report_of(s).faults.at(0).applied_s, 0.0);
}

TEST(RunEnds, AFaultReachesTheBoardOnceAndByItsKind) {
  int times = 0;
  Scenario s = with_two_signals("t:wait '3 ms' t:fault { kind = 'i2c_nack', bus = 'i2c3' }" +
                                std::string(kLooks));
  s.on_fault = [&](const io::FaultCommand& fault) {
    ++times;
    EXPECT_EQ(fault.kind, static_cast<std::uint32_t>(io::FaultKind::i2c_nack));
  };
  report_of(s);
  EXPECT_EQ(times, 1);
}

// The digest is of all that crossed, both ways.
TEST(RunEnds, TheDigestTellsWhatCrossedApart) {
  const auto digest = [](double fault_value, std::int64_t call_ns) {
    Scenario s = with_two_signals("t:fault { kind = 'i2c_nack', bus = 'i2c3', value = " +
                                  std::to_string(fault_value) + " }" + kLooks);
    add_call(s, 5 * kMs, 6 * kMs, call_ns);
    return report_of(s).digest;
  };
  EXPECT_EQ(digest(1, 1000), digest(1, 1000));
  EXPECT_NE(digest(1, 1000), digest(2, 1000));
  EXPECT_NE(digest(1, 1000), digest(1, 1001));
  EXPECT_FALSE(digest(1, 1000).empty());
}

TEST(RunEnds, ProgressIsToldEveryTenMillisecondsOfVirtualTime) {
  const ScratchFolder folder;
  std::vector<std::pair<double, std::string>> told;
  run_scenario(with_two_signals("t:step 'down' t:wait '15 ms' t:step 'up' t:wait '20 ms'"),
               folder.file("plan.lua"),
               [&](const Progress& p) { told.emplace_back(std::round(p.t_s * 1e6), p.step); });
  const std::vector<std::pair<double, std::string>> want{
      {10e3, "down"}, {20e3, "up"}, {30e3, "up"}};
  EXPECT_EQ(told, want);
}

TEST(RunEnds, AReportSaysWhatRan) {
  const results::Report report = report_of(with_two_signals(kLooks));
  EXPECT_EQ(report.plan, "p");
  EXPECT_NE(report.file.find("plan.lua"), std::string::npos);
  EXPECT_EQ(report.tags, std::vector<std::string>{"played"});
  EXPECT_EQ(report.seed, 1u);
  EXPECT_EQ(report.timing_profile, "CPU cycles (+-10 %), crystal ready after 2 ms");
  ASSERT_EQ(report.versions.size(), 1u);
  EXPECT_EQ(report.versions[0].second, "played");
}

TEST(RunEnds, TheHostsTimesArePartsOfItsWhole) {
  const auto begin = std::chrono::steady_clock::now();
  const results::HostTimes host = report_of(with_two_signals(kLooks)).host;
  const std::chrono::duration<double> around = std::chrono::steady_clock::now() - begin;
  const double parts =
      host.start_s + host.target_wait_s + host.world_s + host.script_s + host.logging_s;
  for (double part :
       {host.start_s, host.target_wait_s, host.world_s, host.script_s, host.logging_s}) {
    EXPECT_GT(part, 0.0);
  }
  EXPECT_GE(host.total_s, parts);
  EXPECT_LE(host.total_s, around.count());
}

}  // namespace
}  // namespace whirl::oracle

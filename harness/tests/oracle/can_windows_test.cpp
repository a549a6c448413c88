// Windows on CAN: which frames belong to one, and what is told of them.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/tests/oracle/by_hand.hpp"

namespace whirl::oracle {
namespace {

constexpr std::uint32_t kRawCommand = 5u << 24 | 1030u << 8 | 10,
                        kStatus = 16u << 24 | 1034u << 8 | 41;

Scenario on_can(const std::string& lua) {
  Scenario s = with_two_signals(lua);
  s.other_devices.push_back({"esc_a", "can2", -1, 1});
  return s;
}

// A frame whose last byte is `tail`, 100 us long.
void add_frame(Scenario& s, std::int64_t start_ns, std::uint32_t id, std::int32_t sender = -1,
               std::uint8_t error = 0, std::uint8_t tail = 0xC0, std::uint16_t bus = 2) {
  io::CanRecord r;
  r.start_ns = start_ns;
  r.frame.id = id;
  r.frame.flags = 1;
  r.frame.length = 8;
  r.frame.data[7] = tail;
  r.sender = sender;
  r.error = error;
  r.busy_ns = 103'000;
  const std::int64_t end_ns = start_ns + 100'000;
  s.messages.push_back(
      {end_ns, [=](io::Batch& batch) { batch.add(io::Kind::can_transfer, bus, end_ns, r); }});
}

TEST(CanWindows, CountTheErrorsOfTheirBus) {
  Scenario s = on_can("t:can { bus = 'can2', errors = 1, during = '20 ms' } t:wait '30 ms'");
  EXPECT_TRUE(std::isnan(only(s).measured));  // nothing was sent: nothing is shown
  EXPECT_FALSE(passes(s));
  add_frame(s, 5 * kMs, kRawCommand);
  add_frame(s, 6 * kMs, kRawCommand, -1, 3);
  add_frame(s, 7 * kMs, kRawCommand, -1, 3, 0xC0, 1);  // of another bus
  add_frame(s, 21 * kMs, kRawCommand, -1, 3);          // behind the window
  EXPECT_EQ(only(s).name, "can2 errors");
  EXPECT_EQ(only(s).measured, 1.0);
  EXPECT_TRUE(passes(s));
  add_frame(s, 8 * kMs, kStatus, 0, 4);
  EXPECT_FALSE(passes(s));
}

TEST(CanWindows, PeriodsAreOfOneMessageOfOneNode) {
  Scenario s = on_can(
      "t:can { bus = 'can2', from = 'mcu', message = 1030, period = '5 ms', tolerance = '1 ms', "
      "during = '20 "
      "ms' } t:wait '30 ms'");
  for (int ms : {4, 9, 14, 19}) {
    add_frame(s, ms * kMs, kRawCommand);
    add_frame(s, ms * kMs + 200'000, kStatus, 1);
  }
  EXPECT_TRUE(passes(s));
  add_frame(s, 11 * kMs, kRawCommand, 1);            // of another node
  add_frame(s, 12 * kMs, kRawCommand, -1, 0, 0x40);  // goes on with a transfer
  add_frame(s, 12 * kMs, kRawCommand | 0x80, -1);    // a service
  EXPECT_TRUE(passes(s));
  add_frame(s, 12 * kMs, kRawCommand);
  EXPECT_FALSE(passes(s));
}

TEST(CanWindows, AFrameThatFailedKeepsNoPeriod) {
  Scenario s = on_can(
      "t:can { bus = 'can2', message = 1030, period = '5 ms', tolerance = '1 ms', errors = 9, "
      "during = '20 ms' } "
      "t:wait '30 ms'");
  for (int ms : {4, 9, 14, 19}) add_frame(s, ms * kMs, kRawCommand, -1, ms == 9 ? 3 : 0);
  EXPECT_FALSE(passes(s));
}

TEST(CanWindows, LoadIsTheShareOfTimeWithTheIntermission) {
  Scenario s = on_can("t:can { bus = 'can2', load = '6 %', during = '20 ms' } t:wait '30 ms'");
  for (int i = 0; i < 10; ++i) add_frame(s, (2 + i) * kMs, kStatus, 1);
  const results::Report report = report_of(s);
  ASSERT_EQ(report.expectations.size(), 2u) << report.reason;
  EXPECT_EQ(report.expectations[0].name, "can2 load");
  EXPECT_EQ(report.expectations[0].measured, 10 * 103'000.0 / 20e6 * 100.0);
  EXPECT_TRUE(passes(s));
  for (int i = 0; i < 2; ++i) add_frame(s, (15 + i) * kMs, kStatus, 1);
  EXPECT_FALSE(passes(s));
}

TEST(CanWindows, AWrongWordIsSaid) {
  for (const auto& [lua, words] : std::vector<std::pair<std::string, std::string>>{
           {"t:can { bus = 'can1' }", "no device of"},
           {"t:can { bus = 'i2c3' }", "is no CAN bus"},
           {"t:can { bus = 'can2', from = 'esc1' }", "is no node of can2"},
           {"t:can { bus = 'can2', from = 'mcu', load = '5 %' }", "load is of the whole bus"},
           {"t:can { bus = 'can2', period = '5 ms' }", "period and tolerance go together"}}) {
    const results::Report report = report_of(on_can(lua));
    EXPECT_NE(report.reason.find(words), std::string::npos) << lua << ": " << report.reason;
  }
}

TEST(CanWindows, ABusThatAnotherBoardArbitratesIsNamedThere) {
  for (const auto& [lua, words] : std::vector<std::pair<std::string, std::string>>{
           {"t:can { bus = 'can2', during = '20 ms' }", "'can2' is part of fc/can1"},
           {"t:fault { kind = 'can_no_ack', bus = 'can2' }", "can2 is part of fc/can1"},
           {"t:fault { kind = 'can_cut', device = 'esc_a' }", "can2 is part of fc/can1"}}) {
    Scenario s = on_can(lua);
    s.joined = {{"can2", "fc/can1"}};
    const results::Report report = report_of(s);
    EXPECT_NE(report.reason.find(words), std::string::npos) << lua << ": " << report.reason;
  }
}

// It names no bus of its own.
TEST(CanWindows, AndFaultsTakeThePodsHostForANodeOfItsBus) {
  Scenario s = with_two_signals(
      "t:fault { kind = 'can_late', device = 'host', value = '1 ms' }"
      "t:can { bus = 'can2', from = 'host', during = '20 ms' } t:wait '30 ms'");
  s.other_devices.push_back({.name = "host", .bus = "", .host_on_can = 2});
  s.board_faults.emplace_back("can_late", true);
  int bus = 0, number = -1;
  s.on_fault = [&](const io::FaultCommand& fault) {
    bus = fault.bus;
    number = fault.address;
  };
  add_frame(s, 5 * kMs, kStatus, 3);
  add_frame(s, 6 * kMs, kStatus, -1, 3);  // the microcontroller's
  EXPECT_EQ(only(s).name, "can2 host errors");
  EXPECT_EQ(only(s).measured, 0.0);
  EXPECT_TRUE(passes(s));
  EXPECT_EQ(bus, 2);
  EXPECT_EQ(number, 3);  // behind the three that each board of these has
  for (const auto& [lua, words] : std::vector<std::pair<std::string, std::string>>{
           {"t:can { bus = 'can1', from = 'host' }", "no device of"},
           {"t:fault { kind = 'can_cut', device = 'host' }", "can2 is part of fc/can1"}}) {
    Scenario wrong = with_two_signals(lua);
    wrong.other_devices = s.other_devices;
    wrong.joined = {{"can2", "fc/can1"}};
    const results::Report report = report_of(wrong);
    EXPECT_NE(report.reason.find(words), std::string::npos) << lua << ": " << report.reason;
  }
}

TEST(CanWindows, LatencyEndsWithTheFrameOfTheSetPoints) {
  Scenario s = on_can(
      "t:latency { from = 'imu', through = { 'fw::task' }, to = 'esc_a', at_most = '2 ms', during "
      "= '20 ms' } "
      "t:wait '30 ms'");
  s.messages.push_back(
      {5 * kMs, [](io::Batch& batch) { batch.add(io::Kind::data_ready, 0, 5 * kMs, nullptr, 0); }});
  add_call(s, 5 * kMs + 100'000, 5 * kMs + 200'000);
  add_frame(s, 6 * kMs, kRawCommand);
  add_frame(s, 9 * kMs, kStatus, 1);
  const results::Expectation latency = only(s);
  EXPECT_EQ(latency.measured, 1.1) << latency.note;
}

}  // namespace
}  // namespace whirl::oracle

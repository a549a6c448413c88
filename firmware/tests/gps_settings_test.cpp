// What the GPS driver makes sure of while solutions come: that its receiver still holds what it was told.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "firmware/tests/gps_rig.hpp"

namespace fw {
namespace {

using namespace gps_rig;

// Found at once, and set up.
void settle(Bench& bench) {
  bench.receiver.baud = 57600;
  bench.run_ms(1000);
  ASSERT_TRUE(bench.gps.running());
  ASSERT_EQ(bench.gps.searches(), 0u);
}

TEST(UbloxSettings, EachSettingIsPolledInTurnAndRightBehindASolution) {
  for (const bool six : {true, false}) {
    Bench bench;
    bench.receiver.is_six = six;
    settle(bench);
    const std::size_t told = bench.receiver.told.size();
    fly(bench, 12);
    const Bytes rate = {0x08, 0, 0}, nav5 = {0x24, 0, 0};
    const auto message = [](std::uint8_t id) { return Bytes{0x01, 2, 0, 0x01, id}; };
    std::vector<Bytes> want = {rate, nav5, message(0x02), message(0x12), message(0x06), rate};
    if (!six) want = {rate, nav5, message(0x07), rate, nav5, message(0x07)};
    ASSERT_GE(bench.receiver.polls.size(), 5u);
    for (std::size_t i = 0; i < bench.receiver.polls.size(); ++i) {
      EXPECT_EQ(bench.receiver.polls[i], want.at(i)) << i;
    }
    EXPECT_EQ(bench.receiver.told.size(), told);
    EXPECT_EQ(bench.gps.restored(), 0u);
    EXPECT_TRUE(bench.gps.running());
    const std::size_t polls = bench.receiver.polls.size();
    bench.run_ms(1500);  // none comes: nothing is asked into the silence
    EXPECT_EQ(bench.receiver.polls.size(), polls);
  }
}

TEST(UbloxSettings, WhatOneSettingHasLostIsAllToldAgainWithoutASearch) {
  const std::vector<std::function<void(FakeReceiver&)>> losses = {
      [](FakeReceiver& r) { r.period_ms = 1000; }, [](FakeReceiver& r) { r.model = 0; },
      [](FakeReceiver& r) { r.fix_mode = 3; },     [](FakeReceiver& r) { r.quiet = 0x02; },
      [](FakeReceiver& r) { r.quiet = 0x12; },     [](FakeReceiver& r) { r.quiet = 0x06; }};
  for (const auto& lose : losses) {
    Bench bench;
    settle(bench);
    const std::size_t told = bench.receiver.told.size();
    lose(bench.receiver);
    fly(bench, 12);
    bench.receiver.period_ms = 200, bench.receiver.model = 6, bench.receiver.fix_mode = 2;
    bench.receiver.quiet = 0;
    fly(bench, 2);
    EXPECT_GE(bench.gps.restored(), 1u);
    EXPECT_EQ(bench.gps.searches(), 0u);
    EXPECT_TRUE(bench.gps.running());
    ASSERT_GE(bench.receiver.told.size(), told + 7);  // port, rate, model, PVT and the three
    EXPECT_EQ(bench.receiver.told[told][3], 0x00);
    EXPECT_EQ(bench.receiver.told[told + 1][3], 0x08);
    EXPECT_EQ(bench.receiver.told[told + 2][3], 0x24);
    const std::uint32_t restored = bench.gps.restored();
    fly(bench, 12);
    EXPECT_EQ(bench.gps.restored(), restored);
  }
}

TEST(UbloxSettings, APollThatIsNotAnsweredIsNoLoss) {
  Bench bench;
  bench.receiver.deaf_to_polls = true;
  settle(bench);
  const std::size_t told = bench.receiver.told.size();
  fly(bench, 30);
  EXPECT_GT(bench.receiver.polls.size(), 10u);
  EXPECT_EQ(bench.receiver.told.size(), told);
  EXPECT_EQ(bench.gps.restored(), 0u);
}

// One of the three that stays away for good: what comes is no fix, and was taken for a receiver that runs.
TEST(UbloxSettings, PartsOfSolutionsAloneStartTheSearchAnew) {
  Bench bench;
  settle(bench);
  for (std::uint32_t k = 0; k < 15; ++k) {
    bench.push(0x02, posllh(1000 + 200 * k)), bench.push(0x06, sol(1000 + 200 * k));
    bench.run_ms(180);
  }
  EXPECT_EQ(bench.gps.searches(), 1u);
}

}  // namespace
}  // namespace fw

#include "harness/executive/clock_log.hpp"

#include <gtest/gtest.h>

namespace whirl {
namespace {

TEST(ClockLog, EachChangeIsARowAtItsTime) {
  results::EventLog events;
  io::Batch batch;
  batch.add(io::Kind::clock_setup, 0, 1'000'000, io::ClockSetup{16e6, 16e6, 16e6, 16e6});
  batch.add(io::Kind::clock_setup, 0, 3'000'000, io::ClockSetup{168e6, 168e6, 42e6, 84e6});
  ASSERT_TRUE(events.add(batch));
  results::Report report;
  report.log.push_back({0.002, "plan", "between"});
  log_clocks(events, "RCC", report);
  ASSERT_EQ(report.log.size(), 3u);
  EXPECT_EQ(report.log[0].text, "SYSCLK is 16 MHz, HCLK 16, PCLK1 16, PCLK2 16");
  EXPECT_EQ(report.log[1].text, "between");
  EXPECT_EQ(report.log[2].text, "SYSCLK is 168 MHz, HCLK 168, PCLK1 42, PCLK2 84");
  EXPECT_EQ(report.log[2].t_s, 0.003);
}

TEST(ClockLog, WhatWasLoggedAtTheSameTimeStaysBeforeIt) {
  results::EventLog events;
  io::Batch batch;
  batch.add(io::Kind::clock_setup, 0, 1'000'000, io::ClockSetup{8e6, 8e6, 8e6, 8e6});
  ASSERT_TRUE(events.add(batch));
  results::Report report;
  report.log.push_back({0.001, "plan", "first"});
  report.log.push_back({0.001, "plan", "second"});
  log_clocks(events, "RCC", report);
  ASSERT_EQ(report.log.size(), 3u);
  EXPECT_EQ(report.log[0].text, "first");
  EXPECT_EQ(report.log[1].text, "second");
  EXPECT_EQ(report.log[2].who, "RCC");
}

}  // namespace
}  // namespace whirl

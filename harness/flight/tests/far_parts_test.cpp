// Parts on other boards: who hears of the vehicle, and who tells what a motor's controller was told.
#include "harness/flight/far_parts.hpp"

#include <gtest/gtest.h>

namespace whirl::flight {
namespace {

TEST(FarParts, WhatAReceiverOfOneOfThemFindsIsTakenAndNobodyElses) {
  const FarParts parts({2, 5}, {});
  const auto finds = [&parts](std::uint8_t board, io::Kind kind) {
    return parts.finds({0, kind, board, 0, 0});
  };
  EXPECT_TRUE(finds(2, io::Kind::gnss_solution));
  EXPECT_TRUE(finds(5, io::Kind::gnss_solution));
  EXPECT_FALSE(finds(3, io::Kind::gnss_solution));
  EXPECT_FALSE(finds(2, io::Kind::data_ready));
}

io::Header setpoint_of(std::uint8_t board, std::uint16_t motor) {
  return {0, io::Kind::esc_setpoint, board, motor, 0};
}

TEST(FarParts, AMotorsSetPointCountsAsItComesFromWhoPlaysItsController) {
  const FarParts parts({1}, {{2, std::uint8_t{1}}});
  EXPECT_TRUE(parts.is_esc(setpoint_of(0, 1)));
  EXPECT_FALSE(parts.is_esc(setpoint_of(1, 1)));
  EXPECT_TRUE(parts.is_esc(setpoint_of(1, 2)));
  EXPECT_FALSE(parts.is_esc(setpoint_of(0, 2)));  // what the wire carries there is not told twice
  EXPECT_FALSE(parts.is_esc({0, io::Kind::uart_received, 0, 1, 0}));
}

TEST(FarParts, AControllersStateGoesToTheBoardThatPlaysIt) {
  const FarParts parts({3}, {{2, std::uint8_t{3}}});
  io::Batch sensed;
  parts.send_esc(5, 1, {.speed_rpm = 100.0}, sensed);
  parts.send_esc(5, 2, {.speed_rpm = 200.0}, sensed);
  io::Reader r(sensed.bytes());
  ASSERT_TRUE(r.next());
  EXPECT_EQ(r.header().board, 0);
  ASSERT_TRUE(r.next());
  EXPECT_EQ(r.header().board, 3);
  EXPECT_EQ(r.header().port, 2);
  EXPECT_EQ(r.as<io::EscState>().speed_rpm, 200.0);
}

}  // namespace
}  // namespace whirl::flight

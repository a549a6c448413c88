// Boards besides the first whose parts sense: who of them is heard, and for what.
#include "harness/flight/far_parts.hpp"

#include <gtest/gtest.h>

namespace whirl::flight {
namespace {

TEST(FarParts, WhatAReceiverOfOneOfThemFindsIsTakenAndNobodyElses) {
  const FarParts parts({2, 5});
  const auto finds = [&parts](std::uint8_t board, io::Kind kind) {
    return parts.finds({0, kind, board, 0, 0});
  };
  EXPECT_TRUE(finds(2, io::Kind::gnss_solution));
  EXPECT_TRUE(finds(5, io::Kind::gnss_solution));
  EXPECT_FALSE(finds(3, io::Kind::gnss_solution));
  EXPECT_FALSE(finds(2, io::Kind::data_ready));
}

}  // namespace
}  // namespace whirl::flight

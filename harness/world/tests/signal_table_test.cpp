#include "harness/world/signal_table.hpp"

#include <gtest/gtest.h>

namespace whirl {
namespace {

TEST(SignalTable, FindsByNameAndByNameWithUnit) {
  const std::vector<Signal> signals = {{"height", Dimension::length, ""},
                                       {"armed", Dimension::none, ""}};
  const SignalTable table(signals);
  EXPECT_EQ(table.find("armed"), 1u);
  EXPECT_EQ(table.find_with_unit("height_m"), 0u);
  EXPECT_EQ(table.find_with_unit("armed"), 1u);
  EXPECT_FALSE(table.find("height_m").has_value());
  EXPECT_FALSE(table.find_with_unit("height").has_value());
  EXPECT_EQ(table.names(), "height, armed");
  EXPECT_EQ(table[0].dimension, Dimension::length);
}

}  // namespace
}  // namespace whirl

#include "harness/board/node.hpp"

#include <gtest/gtest.h>

namespace whirl {
namespace {

TEST(NodePlace, TheOnlyBoardNeedsNoName) {
  const std::vector<Node> one{{"", {}}};
  EXPECT_EQ(node_place(one, "fw::task").value().rest, "fw::task");
  EXPECT_EQ(node_place(one, "a/b").value().rest, "a/b");
  const std::vector<Node> named{{"esc", {}}};
  EXPECT_EQ(node_place(named, "imu").value().rest, "imu");
  EXPECT_EQ(node_place(named, "esc/imu").value().rest, "imu");
  EXPECT_FALSE(node_place(named, "fc/imu").ok());
  EXPECT_FALSE(node_place(named, "").ok());
  EXPECT_FALSE(node_place(one, "").ok());
}

TEST(NodePlace, OfSeveralOneIsNamed) {
  const std::vector<Node> two{{"fc", {}}, {"esc", {}}};
  const auto at = node_place(two, "esc/fw::esc::control_task");
  ASSERT_TRUE(at.ok());
  EXPECT_EQ(at.value().node, 1u);
  EXPECT_EQ(at.value().rest, "fw::esc::control_task");
  for (const char* wrong : {"imu", "gps/imu", "/imu", "esc/"}) {
    const auto none = node_place(two, wrong);
    ASSERT_FALSE(none.ok()) << wrong;
    EXPECT_NE(none.error().cure.find("fc, esc"), std::string::npos) << none.error().cure;
  }
}

}  // namespace
}  // namespace whirl

#include "harness/plan/waypoint_file.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "base/near.hpp"

namespace whirl::plan {
namespace {

TEST(WaypointFile, ReadsMetresDegreesAndSeconds) {
  const auto read =
      waypoints_of("a.txt", "# a round\n1 -2.5 -1.1 90 3\r\n\n\t0 0 -0.5 -180 # home\n");
  ASSERT_TRUE(read.ok()) << read.error().message();
  ASSERT_EQ(read.value().size(), 2u);
  const request::Waypoint& first = read.value()[0];
  EXPECT_EQ(first.north_m, 1.0);
  EXPECT_EQ(first.east_m, -2.5);
  EXPECT_EQ(first.down_m, -1.1);
  EXPECT_TRUE(near(first.yaw_rad, std::numbers::pi / 2.0, round_off(2, 1.0)));
  EXPECT_EQ(first.hold_s, 3.0);
  EXPECT_EQ(read.value()[1].hold_s, 0.0);
}

TEST(WaypointFile, AWrongLineIsRefusedWithItsPlace) {
  const struct {
    const char *text, *place, *what;
  } kWrong[] = {
      {"0 0 -1 0\n1 2 -1\n", "w.txt:2", "less than x y z yaw"},
      {"0 0 -1 0 1 2\n", "w.txt:1", "more than x y z yaw hold"},
      {"0 zero -1 0\n", "w.txt:1", "y: 'zero' is no number"},
      {"0 1m -1 0\n", "w.txt:1", "y: '1m' is no number"},
      {"nan 0 -1 0\n", "w.txt:1", "x: 'nan' is no number"},
      {"0 0 -1 inf\n", "w.txt:1", "yaw: 'inf' is no number"},
      {"0 0 1.1 0\n", "w.txt:1", "z: 1.1 is outside -1000 .. -0.01"},
      {"1001 0 -1 0\n", "w.txt:1", "x: 1001 is outside -1000 .. 1000"},
      {"0 0 -1 361\n", "w.txt:1", "yaw: 361 is outside -360 .. 360"},
      {"0 0 -1 0 -1\n", "w.txt:1", "hold: -1 is outside 0 .. 3600"},
      {"\n# nothing\n", "w.txt:2", "no waypoint in the whole file"},
      {"", "w.txt:0", "no waypoint in the whole file"},
  };
  for (const auto& wrong : kWrong) {
    const auto read = waypoints_of("w.txt", wrong.text);
    ASSERT_FALSE(read.ok()) << wrong.text;
    EXPECT_EQ(read.error().kind, ErrorKind::bad_input);
    EXPECT_EQ(read.error().place, wrong.place) << wrong.text;
    EXPECT_EQ(read.error().what, wrong.what);
  }
}

TEST(WaypointFile, AThousandAreEnough) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "0 0 -1 0\n";
  EXPECT_TRUE(waypoints_of("w.txt", text).ok());
  EXPECT_FALSE(waypoints_of("w.txt", text + "0 0 -1 0\n").ok());
}

}  // namespace
}  // namespace whirl::plan

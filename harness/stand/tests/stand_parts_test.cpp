#include "harness/stand/stand_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::stand {
namespace {

StandParams stand_of(const std::string& text) {
  const auto table = lua::read_text("return " + text, "plan.lua");
  EXPECT_TRUE(table.ok());
  auto read = catalogue::read_stand(table.value(),
                                    std::string(WHIRL_SOURCE_FOLDER) + "/test_plans/propellers");
  EXPECT_TRUE(read.ok()) << read.error().message();
  return read.value();
}

BoardDescription board_with_stage() {
  BoardDescription board;
  board.devices = {{.name = "stage",
                    .type = "power_stage",
                    .motor = 1,
                    .keys = {{"params.inductance", 3e-5}, {"params.shunt.gain", 0.1}}}};
  return board;
}

TEST(StandParts, NothingIsDrawnWithoutATolerance) {
  StandParams stand = stand_of(R"({ prop = "hk_10x4.5", supply = "16 V", tolerance = "none" })");
  draw_parts(stand, board_with_stage(), 1);
  EXPECT_TRUE(stand.stage.empty());
  EXPECT_TRUE(stand.drawn.empty());
  EXPECT_EQ(stand.hse_error, 0.0);
}

TEST(StandParts, DrawsAboutWhatTheBoardsFileHasAndSaysWhat) {
  StandParams stand = stand_of(R"({ prop = "hk_10x4.5", supply = "16 V", tolerance = "worst",
                                  shunt = { offset = "4.3 A" } })");
  BoardDescription board = board_with_stage();
  draw_parts(stand, board, 1);
  EXPECT_TRUE(near(std::abs(stand.stage.at("inductance") / 3e-5 - 1.0), 0.3, round_off(8, 1.0)));
  EXPECT_EQ(stand.stage.at("shunt.offset"), 4.3);  // the plan's
  for (const DrawnPart& part : stand.drawn) EXPECT_NE(part.name, "shunt.offset");
  // Three counts of gain and 1.5 % of reference, to either side.
  EXPECT_GT(std::abs(stand.stage.at("adc.gain.a")), 0.014);
  EXPECT_EQ(std::abs(stand.hse_error), 50e-6);
  EXPECT_EQ(std::abs(stand.cell.thrust_gain_error), 0.005);
  ASSERT_TRUE(set_parts(board, stand).ok());
  EXPECT_EQ(board.hse_error, stand.hse_error);
  EXPECT_EQ(board.devices[0].keys.count("params.shunt.gain"), 0u);  // this part's own is drawn
}

TEST(StandParts, GroupsAreChosenOneByOne) {
  StandParams stand = stand_of(R"({ prop = "hk_10x4.5", supply = "16 V",
                                  tolerance = { dividers = "worst" } })");
  draw_parts(stand, board_with_stage(), 3);
  EXPECT_EQ(stand.stage.size(), 4u);
  EXPECT_EQ(stand.drawn.size(), 8u);
  StandParams all = stand_of(R"({ prop = "hk_10x4.5", supply = "16 V",
                                tolerance = { dividers = "worst", rest = "typical" } })");
  draw_parts(all, board_with_stage(), 3);
  EXPECT_EQ(all.stage.at("divider.a"), stand.stage.at("divider.a"));  // the others disturb nothing
}

TEST(StandParts, EveryNumberOfTheStageIsAKeyThatTheStageHas) {
  StandParams stand = stand_of(R"({ prop = "hk_10x4.5", supply = "16 V", tolerance = "worst" })");
  for (std::uint64_t seed = 1; seed < 8; ++seed) {
    StandParams copy = stand;
    BoardDescription board = board_with_stage();
    draw_parts(copy, board, seed);
    ASSERT_TRUE(set_parts(board, copy).ok());
    for (const auto& [key, value] : board.devices[0].keys) {
      const rack::DeviceKey* known =
          rack::find_type(rack::device_types(), "power_stage")->find(key);
      ASSERT_NE(known, nullptr) << key;
      EXPECT_EQ(rack::complaint(*known, value), "") << key;
    }
  }
}

}  // namespace
}  // namespace whirl::stand

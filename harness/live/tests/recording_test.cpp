#include "harness/live/recording.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/scratch_folder.hpp"
#include "base/whole_file.hpp"
#include "harness/plan/plan_file.hpp"

namespace whirl::live {
namespace {

namespace fs = std::filesystem;

class RecordingTest : public ::testing::Test {
 protected:
  RecordingTest() {
    fs::create_directories(scratch_.file("plans/include"));
    fs::create_directories(scratch_.file("run"));
    put("plans/base.lua",
        "include \"include/shared.lua\"\n"
        "plan \"other\" { image = \"flight\", vehicle = \"hp_quad\", run = function() end }\n"
        "plan \"a \\\"b\\\"\" { image = \"flight\", vehicle = \"hp_quad\", seed = 3, run = shared "
        "}\n");
    put("plans/include/shared.lua", "function shared(t) t:wait \"1 s\" end\n");
    flown_.file = scratch_.file("plans/base.lua");
    flown_.name = "a \"b\"";
    flown_.taken_in = {"include/shared.lua"};
    flown_.seed = 77;
    flown_.end_ns = 12'345'000'000;
    flown_.end_m = {{"height", 1.25}};
  }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(scratch_.file(name)) << text;
  }
  std::string text(const std::string& name) const {
    return read_whole_file(scratch_.file("run/" + name)).value();
  }

  ScratchFolder scratch_;
  FlownPlan flown_;
  Recording recording_;
};

TEST_F(RecordingTest, LeavesAPlanWithTheSeedAndTheSettingsThatWereFlown) {
  const std::vector<std::uint8_t> piece{0xFD, 0x00, 0xA5};
  recording_.add(1'234'000'000, piece);
  flown_.settings = {{"vehicle", "hp_quad_st"}};
  ASSERT_TRUE(recording_.write(scratch_.file("run"), flown_).ok());
  const auto file = plan::PlanFile::load(scratch_.file("run/commands.lua"));
  ASSERT_TRUE(file.ok()) << file.error().message();
  ASSERT_EQ(file.value()->plans().size(), 1u);
  const plan::Plan& plan = file.value()->plans()[0];
  EXPECT_EQ(plan.name, "a \"b\", flown again");
  EXPECT_EQ(plan.seed, 77u);
  EXPECT_EQ(plan.vehicle, "hp_quad_st");
  EXPECT_EQ(plan.timeout_ns, 13'345'000'000);
  EXPECT_NE(text("commands_1.lua").find("t:at(\"1.234 s\", { radio = \"fd00a5\" })"),
            std::string::npos);
  EXPECT_NE(text("commands.lua").find("within(\"1.2490 m\", \"1.2510 m\")"), std::string::npos);
}

TEST_F(RecordingTest, SticksAreACommandOfTheTransmitter) {
  request::Sticks sticks;
  sticks.roll = -0.326;
  sticks.thrust = 1.0;
  sticks.mode = 2;
  sticks.arm = false;
  recording_.add(20'000'000, sticks);
  sticks = {};
  sticks.transmitter_on = false;
  recording_.add(40'000'000, sticks);
  EXPECT_EQ(recording_.pieces(), 0u);  // of the radio
  ASSERT_TRUE(recording_.write(scratch_.file("run"), flown_).ok());
  EXPECT_TRUE(plan::PlanFile::load(scratch_.file("run/commands.lua")).ok());
  const std::string written = text("commands_1.lua");
  EXPECT_NE(written.find("t:at(\"0.020 s\", { rc = { roll = \"-32.6 %\", thrust = \"100.0 %\", "
                         "mode = 2, arm = false, on = true } })"),
            std::string::npos)
      << written;
  EXPECT_NE(written.find("t:at(\"0.040 s\", { rc = { on = false } })"), std::string::npos);
}

TEST_F(RecordingTest, ALongFlightIsCutIntoFilesThatAPlanMayTakeIn) {
  const std::vector<std::uint8_t> piece(65, 0x5A);
  for (std::int64_t i = 0; i < 12'000; ++i) recording_.add(i * 100'000'000, piece);
  ASSERT_TRUE(recording_.write(scratch_.file("run"), flown_).ok());
  EXPECT_TRUE(plan::PlanFile::load(scratch_.file("run/commands.lua")).ok());
  std::size_t pieces = 0;
  for (const char* name :
       {"commands_1.lua", "commands_2.lua", "commands_3.lua", "commands_4.lua"}) {
    const std::string part = text(name);
    EXPECT_LT(part.size(), 1u << 20);
    for (auto at = part.find("t:at"); at != std::string::npos; at = part.find("t:at", at + 1)) {
      ++pieces;
    }
  }
  EXPECT_EQ(pieces, 12'000u);
}

TEST_F(RecordingTest, ARecordedFlightCanBeFlownAndRecordedAnew) {
  recording_.add(1'000'000, std::vector<std::uint8_t>{1});
  ASSERT_TRUE(recording_.write(scratch_.file("run"), flown_).ok());
  FlownPlan again;
  again.file = scratch_.file("run/commands.lua");
  again.name = "a \"b\", flown again";
  again.taken_in = {"flown_plan_1.lua", "include/shared.lua", "commands_1.lua"};
  fs::create_directories(scratch_.file("second"));
  ASSERT_TRUE(recording_.write(scratch_.file("second"), again).ok());
  const auto file = plan::PlanFile::load(scratch_.file("second/commands.lua"));
  ASSERT_TRUE(file.ok()) << file.error().message();
  EXPECT_EQ(file.value()->plans()[0].name, "a \"b\", flown again, flown again");
  EXPECT_TRUE(fs::exists(scratch_.file("second/commands_2.lua")));
}

}  // namespace
}  // namespace whirl::live

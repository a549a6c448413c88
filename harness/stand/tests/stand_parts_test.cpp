#include "harness/stand/stand_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/near.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "io_bridges/rack/devices/table.hpp"
#include "plant/parts/vehicle.hpp"

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

VehiclesEscParams escs_of_a_quad(plant::ToleranceClass tolerance, int motor) {
  VehiclesEscParams params{.motor = motor, .shaft = {}, .shunt = {}, .tolerance = {}};
  params.shaft.torque_constant_NmpA = 0.0102;
  for (const char* group : plant::vehicle_groups()) params.tolerance[group] = tolerance;
  return params;
}

// Its own numbers in the same order, the vehicle's and the bench's left out.
TEST(VehiclesEsc, IsTheEscOfAStandWithThatSeedAndKeepsTheVehiclesMotor) {
  StandParams stand = stand_of(R"({ prop = "hk_10x4.5", supply = "16 V" })");
  draw_parts(stand, board_with_stage(), 5);
  const VehiclesEsc esc =
      draw_esc(escs_of_a_quad(plant::ToleranceClass::typical, 1), board_with_stage(), 1, 5);
  const std::set<std::string> vehicles = {"torque_constant", "resistance",    "no_load_current",
                                          "inertia",         "heat_capacity", "bearing_share",
                                          "ambient"};
  std::size_t own = 0;
  for (const DrawnPart& part : stand.drawn) {
    const bool of_bench =
        part.name.find("meter.") != std::string::npos || part.name.rfind("cell.", 0) == 0;
    const auto same = std::find_if(esc.drawn.begin(), esc.drawn.end(), [&](const DrawnPart& its) {
      return its.name == "esc 1 " + part.name;
    });
    ASSERT_EQ(same != esc.drawn.end(), !of_bench && vehicles.count(part.name) == 0) << part.name;
    if (same == esc.drawn.end()) continue;
    ++own;
    EXPECT_EQ(same->value, part.value) << part.name;
  }
  EXPECT_EQ(own, esc.drawn.size());
  for (const auto& [name, value] : esc.stage) {
    if (vehicles.count(name) > 0 || name == "inductance") continue;
    if (name == "shunt.warm_up" || name == "shunt.wander")
      continue;  // a tolerance of the stage's own draws
    EXPECT_EQ(value, stand.stage.at(name)) << name;
  }
  EXPECT_EQ(esc.stage.at("torque_constant"), 0.0102);
  EXPECT_EQ(esc.stage.count("ambient"), 0u);
  EXPECT_EQ(esc.hse_error, stand.hse_error);
  EXPECT_EQ(esc.hsi_error, stand.hsi_error);
}

TEST(VehiclesEsc, FourAreFourCopies) {
  std::vector<VehiclesEsc> four;
  for (int motor = 1; motor <= 4; ++motor) {
    four.push_back(
        draw_esc(escs_of_a_quad(plant::ToleranceClass::typical, motor), board_with_stage(), 1, 1));
    ASSERT_EQ(four.back().drawn.size(), four[0].drawn.size());
    for (std::size_t other = 0; other + 1 < four.size(); ++other) {
      for (std::size_t k = 0; k < four[0].drawn.size(); ++k) {
        EXPECT_NE(four.back().drawn[k].value, four[other].drawn[k].value)
            << four[other].drawn[k].name;
      }
      EXPECT_NE(four.back().hse_error, four[other].hse_error);
    }
  }
}

TEST(VehiclesEsc, WithoutAToleranceItIsTheDrawing) {
  const VehiclesEscParams params = escs_of_a_quad(plant::ToleranceClass::none, 2);
  const VehiclesEsc esc = draw_esc(params, board_with_stage(), 1, 1);
  EXPECT_TRUE(esc.drawn.empty());
  EXPECT_EQ(esc.hse_error, 0.0);
  EXPECT_EQ(esc.hsi_error, 0.0);
  StageParams drawing = stage_of(params.shaft, params.shunt);
  drawing.erase("shunt.gain");  // the board's own says it
  EXPECT_EQ(esc.stage, drawing);
}

// A vehicle that is flown with calibrated current sensors says so; a part's own errors stay with the others' draws.
TEST(VehiclesEsc, WhatTheVehicleStatesOfItsShuntIsNotDrawn) {
  VehiclesEscParams params = escs_of_a_quad(plant::ToleranceClass::typical, 1);
  params.shunt.gain_tolerance = 0.0;
  VehiclesEsc esc = draw_esc(params, board_with_stage(), 1, 1);
  EXPECT_EQ(esc.stage.count("shunt.gain_error"), 0u);
  EXPECT_EQ(esc.stage.at("shunt.gain"), 0.0);
  params.shunt.gain_error = 0.03;
  params.shunt.offset_low_A = params.shunt.offset_high_A = 4.2;
  params.shunt.noise_A = 0.05;
  esc = draw_esc(params, board_with_stage(), 1, 1);
  EXPECT_EQ(esc.stage.at("shunt.gain_error"), 0.03);
  EXPECT_EQ(esc.stage.count("shunt.gain"), 0u);
  EXPECT_EQ(esc.stage.at("shunt.offset"), 4.2);
  EXPECT_EQ(esc.stage.at("shunt.noise"), 0.05);
}

TEST(VehiclesEsc, GroupsOfTheVehicleChooseAndTheBoardIsToldAll) {
  VehiclesEscParams params = escs_of_a_quad(plant::ToleranceClass::none, 3);
  params.tolerance["escs"] = plant::ToleranceClass::worst;
  const VehiclesEsc esc = draw_esc(params, board_with_stage(), 1, 1);
  EXPECT_EQ(esc.stage.count("cogging"), 0u);  // the motors'
  EXPECT_EQ(esc.hse_error, 0.0);
  EXPECT_GT(std::abs(esc.stage.at("adc.gain.a")), 0.014);
  params.tolerance["clock"] = plant::ToleranceClass::worst;
  const VehiclesEsc clocked = draw_esc(params, board_with_stage(), 1, 1);
  EXPECT_EQ(std::abs(clocked.hse_error), 50e-6);
  BoardDescription board = board_with_stage();
  board.hse_error = 1e-6;
  ASSERT_TRUE(set_esc(board, 1, clocked).ok());
  EXPECT_EQ(board.hse_error, 1e-6 + clocked.hse_error);
  EXPECT_EQ(board.hsi_error, clocked.hsi_error);
  for (const auto& [key, value] : board.devices[0].keys) {
    const rack::DeviceKey* known = rack::find_type(rack::device_types(), "power_stage")->find(key);
    ASSERT_NE(known, nullptr) << key;
    EXPECT_EQ(rack::complaint(*known, value), "") << key;
  }
  EXPECT_EQ(std::get<double>(board.devices[0].keys.at("params.divider.b")),
            clocked.stage.at("divider.b"));
  EXPECT_FALSE(set_esc(board, 2, clocked).ok());
}

}  // namespace
}  // namespace whirl::stand

// The parts that vehicles and stands are made of: one reader each, one set of words.
#include <gtest/gtest.h>

#include <numbers>

#include "base/near.hpp"
#include "harness/catalogue/esc_mode.hpp"
#include "harness/catalogue/feed.hpp"
#include "harness/catalogue/motor.hpp"
#include "harness/catalogue/shunt.hpp"
#include "harness/catalogue/stand_table.hpp"

namespace whirl::catalogue {
namespace {

lua::Table table(const std::string& text) {
  auto read = lua::read_text("return " + text, "part.lua");
  EXPECT_TRUE(read.ok()) << read.error().message();
  return read.value();
}

std::string complaint(const lua::Table& t) {
  const auto good = t.finish();
  return good ? "none" : good.error().message();
}

plant::MotorParams motor(const std::string& text, MissingKeys missing) {
  const lua::Table t = table(text);
  const auto params = read_motor(t, missing);
  EXPECT_EQ(complaint(t), "none");
  return params;
}

TEST(Motor, WhatIsNotWrittenIsThePlantsOwnOnlyWhereThatIsAsked) {
  const plant::MotorParams own, read = motor("{ inertia = '+12 %' }", MissingKeys::as_in_plant);
  EXPECT_TRUE(near(read.inertia_kgm2, 1.12 * own.inertia_kgm2, round_off(2, 1e-4)));
  EXPECT_EQ(read.resistance_ohm, own.resistance_ohm);
  EXPECT_EQ(read.inductance_H, own.inductance_H);
  const lua::Table bare = table("{ inertia = '+12 %' }");
  read_motor(bare, MissingKeys::refused);
  EXPECT_NE(complaint(bare).find("kv_rpm_per_V: is missing"), std::string::npos) << complaint(bare);
}

TEST(Motor, SharesAreOfThePlantsOwnOnAVehicleToo) {
  const plant::MotorParams own,
      read = motor(
          "{ kv_rpm_per_V = '+10 %', resistance = '-12 %', no_load_current = '1 A',"
          " inertia = '4e-5 kg m2' }",
          MissingKeys::refused);
  EXPECT_TRUE(near(read.torque_constant_NmpA, own.torque_constant_NmpA / 1.1, round_off(8, 0.01)));
  EXPECT_TRUE(near(read.resistance_ohm, 0.88 * own.resistance_ohm, round_off(2, 0.1)));
  EXPECT_EQ(read.inertia_kgm2, 4e-5);
}

TEST(Motor, AFileIsThatMotorButForTheKeysBesideIt) {
  const std::string stock = std::string(WHIRL_SOURCE_FOLDER) + "/test_plans/motors/d2836_9.lua";
  const plant::MotorParams own,
      read = motor("{ file = '" + stock + "', inertia = '+10 %' }", MissingKeys::refused);
  EXPECT_TRUE(near(read.torque_constant_NmpA, own.torque_constant_NmpA,
                   stated(1e-5, "the plant's own is rounded to a hundred thousandth")));
  EXPECT_TRUE(near(read.inductance_H, own.inductance_H, round_off(4, 2e-5)));
  EXPECT_TRUE(near(read.inertia_kgm2, 1.1 * own.inertia_kgm2, round_off(4, 1e-4)));
  const lua::Table missing = table("{ file = 'nowhere.lua' }");
  read_motor(missing, MissingKeys::refused);
  EXPECT_NE(complaint(missing).find("nowhere.lua"), std::string::npos) << complaint(missing);
}

TEST(Feed, ShortAndLongFormAreTheSamePack) {
  const auto is_lipo = [](const std::string& text) {
    const lua::Table t = table(text);
    const plant::BatteryParams read = read_feed(t), lipo = plant::lipo_4s_2200();
    EXPECT_EQ(complaint(t), "none");
    EXPECT_EQ(read.capacity_C, lipo.capacity_C);
    EXPECT_EQ(read.series_resistance_ohm, lipo.series_resistance_ohm);
    EXPECT_EQ(read.open_circuit.front().voltage_V, lipo.open_circuit.front().voltage_V);
  };
  is_lipo("{ battery = '4s_2200' }");
  is_lipo("{ battery = { pack = '4s_2200' } }");
}

TEST(Feed, AQuarterOfAPackHasAQuarterOfItsChargeAndFourTimesItsResistance) {
  const plant::BatteryParams whole = read_feed(table("{ battery = '4s_2200' }"));
  const plant::BatteryParams share =
      read_feed(table("{ battery = { pack = '4s_2200', share = '25 %' } }"));
  EXPECT_EQ(share.capacity_C, 0.25 * whole.capacity_C);
  EXPECT_EQ(share.series_resistance_ohm, 4.0 * whole.series_resistance_ohm);
}

TEST(Feed, ASupplyIsAVoltageBehindItsLeads) {
  EXPECT_EQ(read_feed(table("{ supply = '16 V' }")).series_resistance_ohm, 0.01);
  const plant::BatteryParams read =
      read_feed(table("{ supply = { voltage = '14 V', resistance = '30 mohm' } }"));
  EXPECT_EQ(read.open_circuit.front().voltage_V, 14.0);
  EXPECT_EQ(read.series_resistance_ohm, 0.03);
}

TEST(Feed, WordsThatNobodyReadsAreRefusedWithThoseThatAre) {
  const auto refused = [](const std::string& text) {
    const lua::Table t = table(text);
    read_feed(t);
    return complaint(t);
  };
  EXPECT_EQ(refused("{ battery = 'lipo_4s_2200' }"),
            "part.lua:1: battery: 'lipo_4s_2200' is not known (use one of 4s_2200)");
  EXPECT_EQ(
      refused("{ battery = { pack = '4s_2200', kind = 'lab_supply' } }"),
      "part.lua:1: unknown key 'battery.kind' (known here: capacity, depth_of_discharge, file, "
      "pack, resistance, share, temperature)");
  EXPECT_NE(refused("{ battery = '4s_2200', supply = '16 V' }").find("one of the two"),
            std::string::npos);
  EXPECT_NE(refused("{ }").find("one of the two"), std::string::npos);
}

TEST(Shunt, AKnownGainLeavesNothingToDraw) {
  const plant::CurrentShuntParams known = read_shunt(table("{ gain = '-5 %', noise = '20 mA' }"));
  EXPECT_EQ(known.gain_error, -0.05);
  EXPECT_EQ(known.gain_tolerance, 0.0);
  EXPECT_EQ(known.noise_A, 0.02);
  EXPECT_EQ(known.noise_per_A, 0.0);
  const plant::CurrentShuntParams drawn = read_shunt(table("{ gain_tolerance = '3 %' }"));
  EXPECT_EQ(drawn.gain_tolerance, 0.03);
  EXPECT_EQ(drawn.noise_per_A, plant::CurrentShuntParams{}.noise_per_A);
  const lua::Table both = table("{ gain = '1 %', gain_tolerance = '3 %' }");
  read_shunt(both);
  EXPECT_NE(complaint(both).find("one of the two"), std::string::npos);
}

// The wire's numbers are those of the ESC32v2's protocol; 3, servo, is not for a propeller.
TEST(EscMode, WireAndCoreAgreeOnEachWord) {
  const char* words[] = {"duty", "rpm", "thrust_by_rpm", nullptr, "power", "thrust_by_power"};
  for (int number = 0; number < 6; ++number) {
    if (words[number] == nullptr) continue;
    const auto mode =
        read_esc_mode(table(std::string("{ mode = '") + words[number] + "' }"), "mode");
    EXPECT_EQ(static_cast<int>(mode.on_wire), number) << words[number];
    EXPECT_EQ(static_cast<int>(mode.in_core), number) << words[number];
  }
  const lua::Table servo = table("{ mode = 'servo' }");
  read_esc_mode(servo, "mode");
  EXPECT_EQ(complaint(servo),
            "part.lua:1: mode: 'servo' is not known (use one of duty, rpm, thrust_by_rpm, power, "
            "thrust_by_power)");
}

TEST(StandTable, OldWordsAreRefusedWithTheList) {
  const auto read = read_stand(
      table("{ prop = 'hk_10x4.5', supply = '16 V', supply_resistance = '10 mohm' }"), "nowhere");
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(
      read.error().message(),
      "part.lua:1: unknown key 'supply_resistance' (known here: address, air, battery, i2c, mode, "
      "motor, prop, serial, shunt, supply, throttle, tolerance)");
}

TEST(StandTable, WhatTheBoardsPowerStageCannotTakeIsRefused) {
  const auto read = read_stand(
      table("{ prop = 'hk_10x4.5', supply = '16 V', motor = { pole_pairs = 6 } }"), "nowhere");
  ASSERT_FALSE(read.ok());
  EXPECT_NE(read.error().message().find("motor.pole_pairs: cannot differ on a stand"),
            std::string::npos);
}

std::string refused_motor(const std::string& motor, const std::string& rest = "") {
  const auto read = read_stand(
      table("{ prop = 'hk_10x4.5', supply = '16 V', motor = { " + motor + " }" + rest + " }"),
      "nowhere");
  return read.ok() ? "" : read.error().message();
}

TEST(StandTable, DiodeAndStartTemperatureReachThePowerStage) {
  const auto read = read_stand(table("{ prop = 'hk_10x4.5', supply = '16 V', motor = { diode_drop "
                                     "= '0.5 V', start_temperature = '80 degC' } }"),
                               WHIRL_SOURCE_FOLDER "/test_plans/propellers");
  ASSERT_TRUE(read.ok()) << read.error().message();
  EXPECT_EQ(read.value().stage.at("diode_drop"), 0.5);
  EXPECT_TRUE(near(read.value().stage.at("start_temperature"), 353.15, round_off(4, 353.15)));
}

TEST(StandTable, DiodeAndStartTemperatureBeyondThePlantsRangeAreRefused) {
  const auto names = [](const std::string& said, const char* key) {
    return said.find(key) != std::string::npos;
  };
  EXPECT_TRUE(names(refused_motor("diode_drop = '3.1 V'"), "motor.diode_drop"));
  EXPECT_TRUE(names(refused_motor("diode_drop = '-0.1 V'"), "motor.diode_drop"));
  EXPECT_TRUE(names(refused_motor("diode_drop = '5 %'"), "motor.diode_drop"));
  EXPECT_TRUE(names(refused_motor("start_temperature = '-80 degC'"), "motor.start_temperature"));
  EXPECT_TRUE(names(refused_motor("start_temperature = '230 degC'"), "motor.start_temperature"));
}

TEST(StandTable, AStartTemperatureOfAMotorWithoutHeatIsRefused) {
  for (const char* tolerance : {"'none'", "{ motor = 'typical' }"}) {
    EXPECT_NE(
        refused_motor("start_temperature = '80 degC'", std::string(", tolerance = ") + tolerance)
            .find("neither warms nor cools"),
        std::string::npos);
  }
}

}  // namespace
}  // namespace whirl::catalogue

#include "harness/catalogue/battery_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "base/whole_file.hpp"
#include "harness/catalogue/feed.hpp"
#include "plant/battery/battery.hpp"
#include "plant/validation/discharge_proof.hpp"

namespace whirl::catalogue {
namespace {

const std::string kShipped =
    std::string(WHIRL_SOURCE_FOLDER) + "/test_plans/batteries/lco_4s_2340.lua";

plant::Proof discharges(const plant::BatteryParams& pack) {
  const auto rows = read_whole_file(std::string(WHIRL_SOURCE_FOLDER) +
                                    "/plant/data/batteries/enertech_spb655060.txt");
  EXPECT_TRUE(rows.ok());
  return plant::discharge_proof(pack, 4, rows.ok() ? rows.value() : "");
}

TEST(BatteryFile, TheShippedPackDischargesAsTheCellItWasFittedToAndAsWasKeptAside) {
  const auto params = read_battery_file(kShipped);
  ASSERT_TRUE(params.ok()) << params.error().message();
  const auto proof = discharges(params.value());
  ASSERT_EQ(proof.figures.size(), 8u);
  for (const plant::Figure& f : proof.figures) {
    EXPECT_TRUE(f.within()) << f.name << ": " << f.measured << " " << f.unit;
    EXPECT_GT(f.measured, 0.1) << f.name;  // a model that is that good was given the answer
  }
}

// As cells are that were bought with a resistance of half as much again, or a seventh less charge.
TEST(BatteryFile, APackThatIsNotThatCellDoesNotDischargeLikeIt) {
  const auto beyond = [](const plant::BatteryParams& pack) {
    int count = 0;
    for (const plant::Figure& f : discharges(pack).figures) count += f.within() ? 0 : 1;
    return count;
  };
  const auto params = read_battery_file(kShipped);
  ASSERT_TRUE(params.ok());
  plant::BatteryParams worn = params.value();
  worn.series_resistance_ohm *= 1.5;
  EXPECT_GE(beyond(worn), 3);
  worn = params.value();
  worn.capacity_C *= 0.85;
  EXPECT_GE(beyond(worn), 4);
  EXPECT_FALSE(plant::discharge_proof(params.value(), 4, "").figures[0].within());  // no rows
}

constexpr const char* kSmall = R"(return { kind = "battery", name = "b", cells = 3, parallel = 2,
  capacity = "1 Ah", open_circuit = { { used = 0, V = 4.2 }, { used = 1, V = 3.0 } },
  resistance = "30 mohm", relaxation = { { resistance = "9 mohm", time = "2 s" } },
  resistance_over_temperature = { { celsius = -10, factor = 3 }, { celsius = 20, factor = 1 } } })";

// The same with one word in place of another.
Result<plant::BatteryParams> read_with(const std::string& from, const std::string& to) {
  const ScratchFolder folder;
  std::string text = kSmall;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  std::ofstream(folder.file("b.lua")) << text;
  return read_battery_file(folder.file("b.lua"));
}

TEST(BatteryFile, CellsInSeriesAddTheirVoltageAndThoseBesideTheirCharge) {
  const auto b = read_with("name", "name");
  ASSERT_TRUE(b.ok()) << b.error().message();
  EXPECT_TRUE(near(b.value().open_circuit.front().voltage_V, 12.6, round_off(2, 12.6)));
  EXPECT_TRUE(near(b.value().capacity_C, 7200.0, round_off(2, 7200.0)));
  EXPECT_TRUE(near(b.value().series_resistance_ohm, 0.045, round_off(4, 0.045)));
  EXPECT_TRUE(near(b.value().relaxation_resistance_ohm, 0.0135, round_off(4, 0.0135)));
}

TEST(BatteryFile, NonsenseIsRefusedWithItsPlace) {
  const std::pair<const char*, const char*> kNonsense[] = {
      {"cells = 3", "cells = 0"},
      {"parallel = 2", "parallel = -1"},
      {"\"30 mohm\"", "\"-30 mohm\""},
      {"\"1 Ah\"", "\"0 Ah\""},
      {"V = 3.0", "V = 4.3"},
      {"{ used = 1, V = 3.0 }", "{ used = 0.9, V = 3.0 }"},
      {", { used = 1, V = 3.0 }", ""},
      {"used = 0,", "used = 1,"},
      {"time = \"2 s\"", "time = \"0 s\""},
      {"factor = 3", "factor = 0"},
      {"celsius = -10", "celsius = 30"},
      {"name = \"b\"", "name = \"b\", chemistry = \"lead\""},
      {"kind = \"battery\"", "kind = \"propeller\""},
      {"{ { resistance = \"9 mohm\", time = \"2 s\" } }", "{ }"},
  };
  for (const auto& [from, to] : kNonsense) {
    const auto read = read_with(from, to);
    ASSERT_FALSE(read.ok()) << to;
    EXPECT_NE(read.error().message().find("b.lua"), std::string::npos) << read.error().message();
  }
}

std::string complaint_of(const std::string& battery) {
  auto read = lua::read_text("return { battery = " + battery + " }",
                             std::string(WHIRL_SOURCE_FOLDER) + "/test_plans/vehicles/v.lua");
  EXPECT_TRUE(read.ok());
  read_feed(read.value());
  const auto good = read.value().finish();
  return good ? "" : good.error().message();
}

TEST(BatteryFile, AVehicleNamesItBesideItself) {
  EXPECT_EQ(complaint_of("{ file = '../batteries/lco_4s_2340.lua', share = '25 %' }"), "");
  EXPECT_NE(complaint_of("{ file = '../batteries/none.lua' }"), "");
  EXPECT_NE(complaint_of("{ file = '../batteries/lco_4s_2340.lua', pack = '4s_2200' }"), "");
  // Nothing was measured of this one at another temperature: no guess.
  EXPECT_NE(complaint_of("{ file = '../batteries/lco_4s_2340.lua', temperature = '5 degC' }"), "");
  EXPECT_NE(complaint_of("{ pack = '4s_2200', temperature = '5 degC' }"), "");
}

}  // namespace
}  // namespace whirl::catalogue

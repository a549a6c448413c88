#include "harness/catalogue/battery_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <span>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "harness/catalogue/feed.hpp"
#include "plant/battery/battery.hpp"

namespace whirl::catalogue {
namespace {

const std::string kShipped =
    std::string(WHIRL_SOURCE_FOLDER) + "/test_plans/batteries/lco_4s_2340.lua";

struct Sample {
  double time_s, cell_V;
};

// Typed from [Enertech]: terminal voltage of one cell under a constant current, from a full cell at rest.
constexpr Sample kOneC[] = {{60, 4.0489},   {360, 3.9442},  {900, 3.8070},  {1500, 3.6956},
                            {2100, 3.6202}, {2880, 3.5401}, {3240, 3.4582}, {3480, 3.3024}};
constexpr Sample kTwoC[] = {
    {5, 4.0104},    {10, 3.9957},   {30, 3.9564},   {60, 3.9176},   {120, 3.8658},  {180, 3.8263},
    {270, 3.7746},  {360, 3.7275},  {450, 3.6837},  {540, 3.6452},  {630, 3.6094},  {720, 3.5773},
    {810, 3.5489},  {900, 3.5235},  {1020, 3.4934}, {1140, 3.4642}, {1230, 3.4415}, {1320, 3.4167},
    {1410, 3.3881}, {1500, 3.3526}, {1590, 3.3045}, {1650, 3.2582}, {1710, 3.1809}, {1740, 3.1099}};

struct Misfit {
  double rms_V = 0.0, worst_V = 0.0;
};

Misfit discharge(double current_A, std::span<const Sample> measured) {
  const auto params = read_battery_file(kShipped);
  EXPECT_TRUE(params.ok()) << (params.ok() ? "" : params.error().message());
  plant::Battery pack(params.value());
  Misfit m;
  double time_s = 0.0, squares = 0.0;
  for (const Sample& s : measured) {
    for (; time_s < s.time_s; time_s += 0.5) pack.draw(current_A * 0.5, 0.5);
    const double cell_V = (pack.source_V() - pack.series_resistance_ohm() * current_A) / 4.0;
    squares += (cell_V - s.cell_V) * (cell_V - s.cell_V);
    m.worst_V = std::max(m.worst_V, std::abs(cell_V - s.cell_V));
  }
  m.rms_V = std::sqrt(squares / static_cast<double>(measured.size()));
  return m;
}

TEST(BatteryFile, TheShippedPackDischargesAsTheCellItWasFittedTo) {
  EXPECT_LE(discharge(2.28, kOneC).rms_V, 0.005);  // three times its scatter over the fit
}

// Twice the current of anything that the fit saw. The measured cell warms, which this one does not: it may
// lie below the measurement, by what 10 K do to a fifth of its drop.
TEST(BatteryFile, TheShippedPackPredictsTheDischargeThatWasKeptAside) {
  const Misfit m = discharge(4.56, kTwoC);
  EXPECT_LE(m.rms_V, 0.030);
  EXPECT_LE(m.worst_V, 0.050);
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

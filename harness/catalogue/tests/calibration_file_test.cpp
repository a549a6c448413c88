// Oracle: what the file says; each mistake is answered with its place and one sentence.
#include "harness/catalogue/calibration_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"

namespace whirl::catalogue {
namespace {

Result<CalibrationFile> read(const std::string& body) {
  const ScratchFolder folder;
  const std::string path = folder.file("calibration_setup.lua");
  std::ofstream(path)
      << "return {\n  kind = \"calibration\",\n  stand = { prop = \"x\", serial = 2 },\n"
      << body << "}\n";
  return read_calibration(path);
}

TEST(CalibrationFile, TakesWhatIsWrittenAndFillsInTheRest) {
  const auto file =
      read("  diameter = \"9 in\", winds = { \"1 m/s\", \"2 m/s\" }, measure = \"2 s\",\n");
  ASSERT_TRUE(file.ok()) << file.error().message();
  const calibrate::Setup& s = file.value().setup;
  EXPECT_EQ(file.value().stand.text("prop"), "x");
  EXPECT_TRUE(near(s.diameter_m, 0.2286, stated(1e-12, "round-off")));
  EXPECT_EQ(s.winds_mps, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(s.measure_ms, 2000);
  EXPECT_EQ(s.serial, 2);
  EXPECT_EQ(s.board, "esc32v2");
  EXPECT_GE(s.still.size(), 4u);
  EXPECT_FALSE(s.tell_motor);
  EXPECT_EQ(s.air_within, 0.03);
  const auto same_day = read("  diameter = \"9 in\", air_within = \"0.5 %\",\n");
  ASSERT_TRUE(same_day.ok()) << same_day.error().message();
  EXPECT_TRUE(near(same_day.value().setup.air_within, 0.005, round_off(1, 1)));
}

TEST(CalibrationFile, TheStandsAirGoesBeforeItsOwnDensity) {
  calibrate::Setup setup;
  setup.density_kgpm3 = 1.19;
  stand::StandParams stand;
  EXPECT_EQ(density_of(setup, stand), 1.19);
  stand.air.emplace().density_kgpm3 = 0.82;
  EXPECT_EQ(density_of(setup, stand), 0.82);
}

TEST(CalibrationFile, RefusesWithPlaceAndReason) {
  const struct {
    const char* body;
    const char* words;
  } cases[] = {
      {"", "diameter"},
      {"  diameter = \"10 V\",\n", "diameter"},
      {"  diameter = \"10 in\", blown = { \"40 %\", \"30 %\", \"50 %\" },\n", "rising"},
      {"  diameter = \"10 in\", blown = { \"40 %\" },\n", "3 duties"},
      {"  diameter = \"10 in\", air_within = \"-3 %\",\n", "air_within"},
      {"  diameter = \"10 in\", wind = { \"1 m/s\" },\n", "wind"},
  };
  for (const auto& c : cases) {
    const auto s = read(c.body);
    ASSERT_FALSE(s.ok()) << c.body;
    EXPECT_EQ(s.error().kind, ErrorKind::bad_input);
    EXPECT_NE(s.error().message().find(c.words), std::string::npos) << s.error().message();
    EXPECT_NE(s.error().place.find("calibration_setup.lua"), std::string::npos);
  }
}

}  // namespace
}  // namespace whirl::catalogue

// Oracle: what the file says; each mistake is answered with its place and one sentence.
#include "harness/calibrate/setup.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "base/scratch_folder.hpp"

namespace whirl::calibrate {
namespace {

Result<Setup> read(const std::string& body) {
  const ScratchFolder folder;
  const std::string path = folder.file("calibration_setup.lua");
  std::ofstream(path)
      << "return {\n  kind = \"calibration\",\n  stand = { prop = \"x\", serial = 2 },\n"
      << body << "}\n";
  return read_setup(path);
}

TEST(Setup, TakesWhatIsWrittenAndFillsInTheRest) {
  const auto s =
      read("  diameter = \"9 in\", winds = { \"1 m/s\", \"2 m/s\" }, measure = \"2 s\",\n");
  ASSERT_TRUE(s.ok()) << s.error().message();
  EXPECT_NEAR(s.value().diameter_m, 0.2286, 1e-12);
  EXPECT_EQ(s.value().winds_mps, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(s.value().measure_ms, 2000);
  EXPECT_EQ(s.value().serial, 2);
  EXPECT_EQ(s.value().board, "esc32v2");
  EXPECT_GE(s.value().still.size(), 4u);
  EXPECT_FALSE(s.value().tell_motor);
}

TEST(Setup, RefusesWithPlaceAndReason) {
  const struct {
    const char* body;
    const char* words;
  } cases[] = {
      {"", "diameter"},
      {"  diameter = \"10 V\",\n", "diameter"},
      {"  diameter = \"10 in\", blown = { \"40 %\", \"30 %\", \"50 %\" },\n", "rising"},
      {"  diameter = \"10 in\", blown = { \"40 %\" },\n", "3 duties"},
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
}  // namespace whirl::calibrate

#include "harness/flight/vehicle_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "harness/base/near.hpp"
#include "harness/flight/tests/paths.hpp"

namespace whirl::flight {
namespace {

const std::string kVehicles = std::string(kSourceFolder) + "/test_plans/vehicles/";

// hp_quad.lua with one passage replaced, in a folder of its own; answers with the complaint.
std::string complaint_about(const std::string& passage, const std::string& instead) {
  std::stringstream text;
  text << std::ifstream(kVehicles + "hp_quad.lua").rdbuf();
  std::string changed = text.str();
  const auto at = changed.find(passage);
  EXPECT_NE(at, std::string::npos) << passage;
  changed.replace(at, passage.size(), instead);
  const auto folder = std::filesystem::path(::testing::TempDir()) / "whirl_vehicle_file_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "quad.lua") << changed;
  const auto result = read_vehicle((folder / "quad.lua").string());
  return result ? "none" : result.error().message();
}

TEST(VehicleFile, HpQuadIsTheVehicleOfTheThesis) {
  const auto params = read_vehicle(kVehicles + "hp_quad.lua");
  ASSERT_TRUE(params.ok()) << params.error().message();
  const plant::VehicleParams& v = params.value().vehicle;
  EXPECT_TRUE(near(v.airframe.mass_kg, 0.900, round_off(2, 1)));
  EXPECT_TRUE(near(v.motor.torque_constant_NmpA, 0.01005, printed_to(1e-5)));  // 60/(2 pi 950)
  EXPECT_TRUE(near(plant::radius_m(*params.value().blade), 0.127, round_off(2, 1)));
  // Motor 1 front, 2 right, 3 rear, 4 left; 1 and 3 counter-clockwise.
  EXPECT_GT(v.airframe.rotors[0].p_BP_B_m.x(), 0.2);
  EXPECT_GT(v.airframe.rotors[1].p_BP_B_m.y(), 0.2);
  EXPECT_LT(v.airframe.rotors[2].p_BP_B_m.x(), -0.2);
  EXPECT_LT(v.airframe.rotors[3].p_BP_B_m.y(), -0.2);
  EXPECT_EQ(v.airframe.rotors[0].spin, 1);
  EXPECT_EQ(v.airframe.rotors[1].spin, -1);
  EXPECT_EQ(params.value().esc.mode, io::EscMode::thrust_by_rpm);
}

TEST(VehicleFile, EachMistakeIsOneSentenceWithItsPlace) {
  struct Case {
    const char *passage, *instead, *expected;
  };
  const Case cases[] = {
      {"\"900 g\"", "\"-900 g\"", "quad.lua:7: mass: '-900 g' must be positive"},
      {"\"25 cm\"", "\"25 furlong\"", "furlong"},
      {"mass = ", "masse = ", "mass"},
      {"\"thrust_by_rpm\"", "\"thrust_by_power\"", "esc.mode: 'thrust_by_power' is not known"},
      {"{ \"0.0125 kg m2\", ", "{ ", "needs three values"},
      {"hk_10x4.5.lua", "hk_99.lua", "hk_99.lua"},
  };
  for (const Case& c : cases) {
    const std::string complaint = complaint_about(c.passage, c.instead);
    EXPECT_NE(complaint.find(c.expected), std::string::npos) << complaint;
    EXPECT_EQ(complaint.find('\n'), std::string::npos) << complaint;
  }
}

}  // namespace
}  // namespace whirl::flight

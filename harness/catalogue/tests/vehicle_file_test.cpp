#include "harness/catalogue/vehicle_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/flight/flight_world.hpp"
#include "harness/flight/tests/paths.hpp"
#include "harness/stand/stand_world.hpp"

namespace whirl::catalogue {
namespace {

const std::string kVehicles = std::string(flight::kSourceFolder) + "/test_plans/vehicles/";

// hp_quad.lua with one passage replaced, in a folder of its own.
Result<flight::FlightParams> read_changed(const std::string& passage, const std::string& instead) {
  std::stringstream text;
  text << std::ifstream(kVehicles + "hp_quad.lua").rdbuf();
  std::string changed = text.str();
  const auto at = changed.find(passage);
  EXPECT_NE(at, std::string::npos) << passage;
  changed.replace(at, passage.size(), instead);
  // Its own paths lead to the propellers and to the polars.
  const ScratchFolder root;
  std::filesystem::create_directories(root.file("test_plans/vehicles"));
  for (const char* folder : {"/test_plans/propellers", "/plant"}) {
    std::filesystem::create_directory_symlink(flight::kSourceFolder + std::string(folder),
                                              root.path() + folder);
  }
  const std::string file = root.file("test_plans/vehicles/quad.lua");
  std::ofstream(file) << changed;
  return read_vehicle(file);
}

std::string complaint_about(const std::string& passage, const std::string& instead) {
  const auto result = read_changed(passage, instead);
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
  const fw::esc::Calibration& c = params.value().esc.calibration;
  EXPECT_EQ(c.mode, fw::esc::Mode::thrust_by_speed);
  EXPECT_EQ(c.motor.max_current_A, 20.0f);
  EXPECT_EQ(c.arming_voltage_V, 15.7f);
  EXPECT_FALSE(c.identified);
  EXPECT_EQ(params.value().esc.pole_pairs, 7);
}

// A propeller's file whose static power is of something else: half as much again as its shape takes.
std::string file_of_doubtful_propeller(const ScratchFolder& folder) {
  std::stringstream text;
  text << std::ifstream(kVehicles + "../propellers/gwssf_11x4.7.lua").rdbuf();
  std::string changed = text.str();
  std::size_t rows = 0;
  for (auto at = changed.find("CP = "); at != std::string::npos; at = changed.find("CP = ", at)) {
    at += 5;
    const double CP = std::stod(changed.substr(at));
    changed.replace(at, changed.find_first_of(" ,}", at) - at, std::to_string(1.5 * CP));
    ++rows;
  }
  EXPECT_GT(rows, 0u);
  const std::string path = folder.file("doubtful.lua");
  std::ofstream(path) << changed;
  return path;
}

void expect_doubt(const std::vector<std::string>& doubts) {
  ASSERT_FALSE(doubts.empty());
  bool told = false;
  for (const std::string& doubt : doubts) {
    told = told || doubt.find("static power is +") != std::string::npos;
    EXPECT_EQ(doubt.find("GWS"), 0u) << doubt;  // whose it is
  }
  EXPECT_TRUE(told) << doubts.front();
}

TEST(VehicleFile, DoubtsOfItsPropellerStayWithTheVehicleAndReachItsRun) {
  const ScratchFolder folder;
  const auto own = read_changed("../propellers/hk_10x4.5.lua", file_of_doubtful_propeller(folder));
  ASSERT_TRUE(own.ok()) << own.error().message();
  expect_doubt(own.value().doubts);
  EXPECT_NE(own.value().fit, nullptr);
  expect_doubt(flight::FlightWorld(own.value(), 1).doubts());
  EXPECT_TRUE(read_vehicle(kVehicles + "hp_quad.lua").value().doubts.empty());
}

TEST(StandFile, DoubtsOfItsPropellerStayWithTheStandAndReachItsRun) {
  const ScratchFolder folder;
  file_of_doubtful_propeller(folder);
  auto table = lua::read_text("return { prop = 'doubtful', battery = '4s_2200' }", "stand");
  ASSERT_TRUE(table.ok());
  const auto own = read_stand(table.value(), folder.path());
  ASSERT_TRUE(own.ok()) << own.error().message();
  expect_doubt(own.value().doubts);
  expect_doubt(stand::StandWorld(own.value(), 1).doubts());
}

// 1.5/pi x 7 x 523.6 rad/s x 20 uH = 35 mohm of commutation at 5000 rpm.
TEST(VehicleFile, ResistanceOfARunningMotorLosesItsCommutation) {
  const auto params =
      read_changed("resistance = \"120 mohm\"",
                   "resistance = \"155 mohm\", resistance_fitted_at = \"5000 rpm\"");
  ASSERT_TRUE(params.ok()) << params.error().message();
  EXPECT_TRUE(near(params.value().vehicle.motor.resistance_ohm, 0.120, printed_to(1e-3)));
  EXPECT_NE(complaint_about("resistance = \"120 mohm\"",
                            "resistance = \"30 mohm\", resistance_fitted_at = \"5000 rpm\"")
                .find("resistance_fitted_at"),
            std::string::npos);
}

TEST(VehicleFile, InductanceThatNobodyPrintsIsTheUsualOne) {
  const auto params = read_changed("inductance = \"20 uH\",", "");
  ASSERT_TRUE(params.ok()) << params.error().message();
  EXPECT_TRUE(near(params.value().vehicle.motor.inductance_H, 24e-6, round_off(8, 24e-6)));
}

// A flat hexa: motors are listed, each with its place from the centre of mass and its sense.
TEST(VehicleFile, MotorsAreListedOrTheArmOfAQuadIsTold) {
  std::string motors = "motors = {";
  for (int i = 0; i < 6; ++i) {
    motors += " { place = { forward = '" + std::to_string(10 * i) + " cm', right = '-5 cm'" +
              (i == 0 ? ", above = '7 cm'" : "") + " }, spin = '" + (i % 2 == 0 ? "cw" : "ccw") +
              "' },";
  }
  motors += " },";
  const auto hexa = read_changed("arm = \"25 cm\",", motors);
  ASSERT_TRUE(hexa.ok()) << hexa.error().message();
  const auto& rotors = hexa.value().vehicle.airframe.rotors;
  ASSERT_EQ(rotors.size(), 6u);
  EXPECT_TRUE(near(rotors[3].p_BP_B_m.x(), 0.3, round_off(4, 1)));
  EXPECT_TRUE(near(rotors[3].p_BP_B_m.y(), -0.05, round_off(4, 1)));
  EXPECT_TRUE(near(rotors[0].p_BP_B_m.z(), -0.07, round_off(4, 1)));
  EXPECT_TRUE(near(rotors[3].p_BP_B_m.z(), -0.03, round_off(4, 1)));  // the file's rotor_height
  EXPECT_EQ(rotors[0].spin, -1);
  EXPECT_EQ(rotors[1].spin, +1);
  EXPECT_EQ(rotors[5].radius_m, plant::radius_m(*hexa.value().blade));
  EXPECT_NE(complaint_about("arm = \"25 cm\",", "").find("arm: either"), std::string::npos);
  EXPECT_NE(complaint_about("arm = \"25 cm\",", "arm = \"25 cm\", " + motors).find("arm: either"),
            std::string::npos);
  const std::string none = complaint_about("arm = \"25 cm\",", "motors = {},");
  EXPECT_NE(none.find("motors: 1 to 12 motors are wanted, not 0"), std::string::npos) << none;
  EXPECT_NE(none.find(".lua:"), std::string::npos) << none;
  const std::string shared = complaint_about("arm = \"25 cm\",", R"(motors = {
      { place = { forward = '10 cm', right = '5 cm' }, spin = 'cw' },
      { place = { forward = '20 cm', right = '5 cm' }, spin = 'cw' },
      { place = { forward = '105 mm', right = '5 cm' }, spin = 'ccw' } },)");
  EXPECT_NE(shared.find("motors[3].place: is that of motor 1, within 1 cm"), std::string::npos)
      << shared;
}

TEST(VehicleFile, ControllerIsOneOfTheTableAndTheFirstWhereNothingIsSaid) {
  const std::string key = "esc = { mode = \"thrust_by_rpm\"";
  const auto said = read_changed(key, "esc = { controller = \"esc_core\", mode = \"rpm\"");
  ASSERT_TRUE(said.ok()) << said.error().message();
  EXPECT_EQ(said.value().controller, "esc_core");
  EXPECT_EQ(read_changed(key, "esc = { mode = \"rpm\"").value().controller, "esc_core");
  const std::string refused = complaint_about(key, "esc = { controller = \"toy\", mode = \"rpm\"");
  EXPECT_NE(refused.find("controller"), std::string::npos) << refused;
  EXPECT_NE(refused.find("esc_core"), std::string::npos) << refused;
}

TEST(VehicleFile, CalibrationHasTheNamesOfTheImagesSet) {
  const auto params = read_changed(
      "esc = { mode = \"thrust_by_rpm\"",
      "esc = { calibration = { kt = 0.0101, c0 = 0.07, d1 = -1.7e5, identified = true }, "
      "shunt = { offset = \"4.3 A\" }, mode = \"thrust_by_power\"");
  ASSERT_TRUE(params.ok()) << params.error().message();
  const flight::EscParams& esc = params.value().esc;
  EXPECT_EQ(esc.calibration.mode, fw::esc::Mode::thrust_by_power);
  EXPECT_EQ(esc.calibration.motor.Kt_NmpA, 0.0101f);
  EXPECT_EQ(esc.calibration.rotor.c0, 0.07f);
  EXPECT_EQ(esc.calibration.rotor.d1, -1.7e5f);
  EXPECT_TRUE(esc.calibration.identified);
  EXPECT_EQ(esc.shunt.offset_low_A, 4.3);
  EXPECT_EQ(esc.shunt.offset_high_A, 4.3);
}

TEST(VehicleFile, StillAirIsToldToCalibratedEscsOnly) {
  const auto with = [](const std::string& more) {
    return read_changed("esc = {", "esc = { still_air = { thrust = '2.2 N'" + more + ",");
  };
  const auto params = with(", warm_up = '20 s' }, calibration = { identified = true }");
  ASSERT_TRUE(params.ok()) << params.error().message();
  EXPECT_EQ(params.value().still_air->thrust_N, 2.2);
  EXPECT_EQ(params.value().still_air->warm_up_ns, 20'000'000'000);
  EXPECT_FALSE(read_changed("esc = {", "esc = {").value().still_air);
  for (const char* end : {"0.8 N", "8 N"}) {  // of the mode's range
    EXPECT_TRUE(read_changed("esc = {", "esc = { still_air = { thrust = '" + std::string(end) +
                                            "' }, calibration = { identified = true },")
                    .ok())
        << end;
  }
  const std::pair<std::string, std::string> wrong[] = {
      {" }", "esc.still_air: wants an ESC with a calibration"},
      {", warm_up = '1 s' }, calibration = { identified = true }",
       "esc.still_air.warm_up: must be"},
      {", speed = 1 }, calibration = { identified = true }", "esc.still_air.speed"}};
  for (const auto& [more, complaint] : wrong) {
    const auto refused = with(more);
    ASSERT_FALSE(refused.ok()) << more;
    EXPECT_NE(refused.error().message().find(complaint), std::string::npos)
        << refused.error().message();
  }
}

TEST(VehicleFile, CalibrationComesFromTheFileOfAStand) {
  const ScratchFolder folder;
  const std::string path = folder.file("esc_calibration.lua");
  const auto with_file = [&path](const std::string& text, const std::string& more = "") {
    std::ofstream(path) << text;
    return read_changed("esc = {", "esc = { calibration = { file = '" + path + "'" + more + " },");
  };
  const std::string good =
      "return { kind = 'esc_calibration', set = { 'set kt 0.0101', "
      "'set d1 -1.7e+5' } }";
  const auto params = with_file(good, ", kt = 0.0102");
  ASSERT_TRUE(params.ok()) << params.error().message();
  EXPECT_EQ(params.value().esc.calibration.rotor.d1, -1.7e5f);
  EXPECT_EQ(params.value().esc.calibration.motor.Kt_NmpA, 0.0102f);  // what stands here wins
  EXPECT_TRUE(params.value().esc.calibration.identified);
  for (const char* bad : {"set ktt 1", "set kt", "set kt 1 2", "get kt 1", "set kt one"}) {
    const auto refused =
        with_file(std::string("return { kind = 'esc_calibration', set = { '") + bad + "' } }");
    ASSERT_FALSE(refused.ok()) << bad;
    EXPECT_NE(refused.error().message().find(bad), std::string::npos);
  }
  EXPECT_FALSE(with_file("return { kind = 'vehicle' }").ok());
}

TEST(VehicleFile, OcclusionIsAShareOfTheCamerasFramesAndNeverAllOfThem) {
  const auto chance = [](const std::string& said) {
    const auto params = read_changed("capture = {", "capture = { " + said);
    EXPECT_TRUE(params.ok()) << said;
    return params.ok() ? params.value().capture.cameras.occlusion_chance : -1.0;
  };
  EXPECT_EQ(chance(""), 0.0);
  EXPECT_TRUE(near(chance("occlusion_chance = \"80 %\","), 0.8, round_off(2, 1)));
  EXPECT_TRUE(near(chance("occlusion_chance = \"99 %\","), 0.99, round_off(2, 1)));
}

TEST(VehicleFile, EachMistakeIsOneSentenceWithItsPlace) {
  struct Case {
    const char *passage, *instead, *expected;
  };
  const Case cases[] = {
      {"\"900 g\"", "\"-900 g\"", "quad.lua:7: mass: '-900 g' must be positive"},
      {"\"25 cm\"", "\"25 furlong\"", "furlong"},
      {"mass = ", "masse = ", "mass"},
      {"\"thrust_by_rpm\"", "\"servo\"", "esc.mode: 'servo' is not known"},
      {"esc = {", "esc = { calibration = { Kt = 0.01 },", "Kt"},
      {"esc = {", "esc = { calibration = { q2 = 1e300 },", "esc.calibration.q2"},
      {"esc = {", "esc = { calibration = { kt = -1 },", "esc.calibration.kt: must be above 0"},
      {"\"15.7 V\"", "\"1e39 V\"", "esc.arming_voltage"},
      {"esc = {", "esc = { shunt = { gain_tolerance = \"70 %\" },", "gain_tolerance"},
      {"{ \"0.0125 kg m2\", ", "{ ", "needs three values"},
      {"hk_10x4.5.lua", "hk_99.lua", "hk_99.lua"},
      {"arm = ", "unbalance_g_mm = { 1, 2 }, arm = ", "unbalance_g_mm: needs 4 values"},
      {"0.0283 }", "}", "frontal_areas_m2: needs three, along x, y and z"},
      {"1.15 }", "-1 }", "drag_coefficients"},
      {"drag_coefficients = ", "drag_coefficient = ", "drag_coefficients"},
      {"capture = {", "capture = { occlusion_chance = \"100 %\",",
       "capture.occlusion_chance: '100 %' must be"},
      {"capture = {", "capture = { occlusion_chance = \"-1 %\",",
       "capture.occlusion_chance: '-1 %' must be"},
      {"capture = {", "capture = { occlusion_chance = \"1 s\",", "capture.occlusion_chance"},
  };
  for (const Case& c : cases) {
    const std::string complaint = complaint_about(c.passage, c.instead);
    EXPECT_NE(complaint.find(c.expected), std::string::npos) << complaint;
    EXPECT_EQ(complaint.find('\n'), std::string::npos) << complaint;
  }
}

}  // namespace
}  // namespace whirl::catalogue

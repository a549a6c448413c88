#include "harness/catalogue/surroundings_table.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "base/near.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "plant/air/atmosphere.hpp"

namespace whirl::catalogue {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

const flight::FlightParams& hp_quad_file() {
  static const auto params =
      read_vehicle(std::string(WHIRL_SOURCE_FOLDER) + "/test_plans/vehicles/hp_quad.lua");
  EXPECT_TRUE(params.ok());
  return params.value();
}

Result<flight::FlightParams> around(const std::string& text) {
  flight::FlightParams params = hp_quad_file();
  auto read = lua::read_text("return {\n" + text + "\n}", "plan.lua");
  if (!read) return read.error();
  if (const auto good = read_surroundings(read.value(), params); !good) return good.error();
  return params;
}

flight::FlightParams sound(const std::string& text) {
  const auto params = around(text);
  EXPECT_TRUE(params.ok()) << params.error().message();
  return params.ok() ? params.value() : flight::FlightParams{};
}

TEST(Surroundings, NothingSaidIsTheRoomOfTheThesisAndAStartOnTheFloor) {
  const flight::FlightParams p = sound("");
  EXPECT_FALSE(p.place.start);
  EXPECT_TRUE(p.vehicle.obstacles.empty());
  EXPECT_EQ(p.capture.cameras.high_W_m.x(), 2.5);
  EXPECT_EQ(p.place.fence->half_size_m.y(), 2.0);
  EXPECT_EQ(p.vehicle.air.ground_temperature_offset_K, 0.0);
}

TEST(Surroundings, AStartHasPlaceAttitudeVelocityAndRates) {
  const flight::FlightParams p = sound(R"(start = { height = "2 m", north = "1 m", east = "-1.5 m",
    yaw = "90 deg", pitch = "30 deg", velocity_north = "1 m/s", climb = "-3 m/s",
    rate_z = "57.29577951308232 deg/s", motor_speed = "3000 rpm" })");
  ASSERT_TRUE(p.place.start);
  const flight::Start& s = *p.place.start;
  EXPECT_EQ(s.p_WB_W_m, Eigen::Vector3d(1.0, -1.5, -2.0));
  EXPECT_EQ(s.v_WB_W_mps, Eigen::Vector3d(1.0, 0.0, 3.0));
  EXPECT_TRUE(near(s.w_WB_B_radps.z(), 1.0, round_off(4, 1.0)));
  EXPECT_TRUE(near(s.motor_speed_radps, 100.0 * std::numbers::pi, round_off(4, 314.0)));
  // Nose to the east and 30 deg up.
  const Eigen::Vector3d nose_W = s.q_WB * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(near(nose_W.y(), std::cos(30 * kDeg), round_off(8, 1.0)));
  EXPECT_TRUE(near(nose_W.z(), -0.5, round_off(8, 1.0)));
}

TEST(Surroundings, AStartWithoutAHeightStandsOnItsGear) {
  EXPECT_TRUE(near(sound("start = { yaw = '90 deg' }").place.start->p_WB_W_m.z(), -0.11,
                   round_off(4, 1.0)));
}

TEST(Surroundings, ARoomSetsWhatTheCamerasSeeAndTheFence) {
  const flight::FlightParams p = sound("room = { size = { '8 m', '6 m', '4 m' }, solid = true }");
  EXPECT_EQ(p.capture.cameras.low_W_m, Eigen::Vector3d(-4.0, -3.0, -4.0));
  EXPECT_EQ(p.capture.cameras.high_W_m.head<2>(), Eigen::Vector2d(4.0, 3.0));
  EXPECT_TRUE(near(p.place.fence->margin_m({0.0, -2.0, -1.0}), 1.0, round_off(4, 4.0)));
  EXPECT_TRUE(near(p.place.fence->margin_m({0.0, 0.0, -4.5}), -0.5, round_off(4, 4.0)));
  ASSERT_EQ(p.vehicle.obstacles.size(), 5u);
  for (const auto& o : p.vehicle.obstacles) EXPECT_GT(plant::distance_m(o, {0, 0, -1}), 2.9);
  EXPECT_TRUE(near(plant::distance_m(p.vehicle.obstacles[2], {0, 2.5, -1}), 0.5, round_off(8, 6)));
}

TEST(Surroundings, OutdoorsThereAreNoCamerasAndAFenceOnlyIfOneIsSet) {
  const flight::FlightParams free = sound("outdoors = true");
  EXPECT_GT(free.capture.cameras.low_W_m.x(), free.capture.cameras.high_W_m.x());
  EXPECT_FALSE(free.place.fence);
  const auto fenced = sound("outdoors = true, fence = { radius = '50 m', height = '30 m' }");
  EXPECT_TRUE(near(fenced.place.fence->margin_m({30.0, -40.0, -29.0}), 0.0, round_off(4, 50)));
  EXPECT_TRUE(near(fenced.place.fence->margin_m({3.0, -4.0, -29.0}), 1.0, round_off(4, 50)));
}

TEST(Surroundings, ObstaclesAreWhatTheirKindSays) {
  const auto p = sound(R"(obstacles = {
    { kind = "slope", north = "2 m", angle = "10 deg", towards = "0 deg" },
    { kind = "wall", distance = "3 m", towards = "90 deg" },
    { kind = "ceiling", height = "3 m" },
    { kind = "box", north = "1 m", size = { "50 cm", "1 m", "40 cm" }, base = "10 cm" } })");
  const auto& all = p.vehicle.obstacles;
  ASSERT_EQ(all.size(), 4u);
  const Tolerance ulps = round_off(8, 4.0);
  EXPECT_TRUE(near(plant::distance_m(all[0], {4.0, 0.0, -2.0 * std::tan(10 * kDeg)}), 0.0, ulps));
  EXPECT_TRUE(near(plant::distance_m(all[1], {0.0, 2.0, -1.0}), 1.0, ulps));
  EXPECT_TRUE(near(plant::distance_m(all[2], {0.0, 2.0, -1.0}), 2.0, ulps));
  EXPECT_TRUE(near(plant::distance_m(all[3], {1.0, 0.0, -1.0}), 0.5, ulps));
}

TEST(Surroundings, FieldAndAirAreThoseOfThePlace) {
  const auto p =
      sound(R"(field = { strength = "50 uT", inclination = "60 deg", declination = "0 deg" },
    air = { temperature = "35 degC", above_sea = "1000 m" })");
  EXPECT_TRUE(near(p.place.magnetic_field_W_T.x(), 25e-6, round_off(8, 5e-5)));
  EXPECT_TRUE(
      near(p.place.magnetic_field_W_T.z(), 50e-6 * std::sin(60 * kDeg), round_off(8, 5e-5)));
  const plant::AirParams& air = p.vehicle.air;
  EXPECT_TRUE(
      near(plant::standard_atmosphere(1000.0, air.ground_temperature_offset_K).temperature_K,
           308.15, round_off(4, 308.0)));
}

TEST(Surroundings, AirMayGrowWarmerUpwards) {
  EXPECT_FALSE(sound("air = { temperature = '5 degC' }").vehicle.air.temperature_gradient_Kpm);
  const auto p = sound("air = { temperature = '5 degC', temperature_gradient = '20 K/km' }");
  EXPECT_TRUE(near(p.vehicle.air.temperature_gradient_Kpm.value(), 0.02, round_off(2, 1)));
}

TEST(Surroundings, AirMayBlowSteadilyAndInGusts) {
  const auto p =
      sound("air = { wind_north = '-1 m/s', wind_east = '3 m/s', turbulence = '2 m/s' }");
  EXPECT_EQ(p.vehicle.air.steady_wind_W_mps, Eigen::Vector3d(-1.0, 3.0, 0.0));
  EXPECT_EQ(p.vehicle.air.dryden.wind_at_6m_mps, 2.0);
}

TEST(Surroundings, ALoadHangsOnALine) {
  const auto p = sound("load = { mass = '200 g', line = '80 cm', below = '4 cm' }");
  ASSERT_TRUE(p.vehicle.load);
  EXPECT_TRUE(near(p.vehicle.load->mass_kg, 0.2, round_off(2, 1)));
  EXPECT_EQ(p.vehicle.load->line_m, 0.8);
  EXPECT_EQ(p.vehicle.load->attach_B_m.z(), 0.04);
}

TEST(Surroundings, WhereNothingIsSaidOfTheStartItIsLookedAtToo) {
  const std::string box = R"(obstacles = { { kind = "box", size = { "1 m", "1 m", "40 cm" } } })";
  const auto within = around(box);
  ASSERT_FALSE(within.ok());
  EXPECT_NE(within.error().message().find("start: feet, hubs or propellers"), std::string::npos);
  EXPECT_FALSE(around(R"(room = { size = { "1 cm", "1 cm", "1 cm" }, solid = true })").ok());
  EXPECT_TRUE(around(box + R"(, start = { height = "80 cm" })").ok());
}

TEST(Surroundings, EachMistakeIsOneSentenceWithItsPlace) {
  const struct {
    const char *text, *expected;
  } cases[] = {
      {"start = { height = '2' }", "plan.lua:2: start.height"},
      {"start = { height = '2 s' }", "start.height"},
      {"start = { hight = '2 m' }", "unknown key 'start.hight'"},
      {"start = { height = '5 cm' }", "from 0.110 m up"},
      {"start = { roll = '90 deg', height = '20 cm' }", "start.height: feet, hubs or propellers"},
      {"start = { velocity_north = '1 m' }", "start.velocity_north"},
      {"start = { climb = '1000 m/s' }", "start.climb"},
      {"start = { north = '2.7 m', height = '1 m' }, room = { size = { '5 m', '4 m', '3 m' }, "
       "solid = true }",
       "start.height: feet"},
      {"room = { size = { '5 m', '4 m' } }", "room.size: needs three"},
      {"room = { size = { '5 m', '4 m', '3 m' } }, outdoors = true",
       "room: there is none outdoors"},
      {"fence = { radius = '5 m' }", "fence.height"},
      {"obstacles = { { kind = 'tree' } }", "'tree' is not known"},
      {"obstacles = { { kind = 'slope' } }", "angle"},
      {"obstacles = { { kind = 'wall', distance = '-1 m' } }", "must be positive"},
      {"field = { strength = '50 uT', inclination = '100 deg', declination = '0 deg' }",
       "field.inclination"},
      {"air = { temperature = '100 degC' }", "air.temperature"},
      {"air = { temperature_gradient = '1 K/m' }", "air.temperature_gradient"},
      {"air = { temperature_gradient = '1 K' }", "air.temperature_gradient"},
      {"air = { turbulence = '-1 m/s' }", "air.turbulence"},
      {"load = { mass = '200 g' }", "load.line"},
      {"load = { mass = '0 g', line = '1 m' }", "load.mass"},
      {"sart = { height = '2 m' }", "unknown key 'sart'"},
  };
  for (const auto& c : cases) {
    const auto read = around(c.text);
    const std::string complaint = read ? "none" : read.error().message();
    EXPECT_NE(complaint.find(c.expected), std::string::npos) << c.text << "\n" << complaint;
  }
}

}  // namespace
}  // namespace whirl::catalogue

// The air that a stand's propeller turns in.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/near.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/stand/stand_world.hpp"

namespace whirl::stand {
namespace {

StandParams stand_in(const std::string& air) {
  const auto table = lua::read_text(R"(return { prop = "hk_10x4.5", supply = "16 V")" +
                                        (air.empty() ? "" : ", air = " + air) + " }",
                                    "plan.lua");
  auto params = catalogue::read_stand(table.value(),
                                      std::string(WHIRL_SOURCE_FOLDER) + "/test_plans/propellers");
  EXPECT_TRUE(params.ok()) << params.error().message();
  return params.value();
}

// What the thrust settles to at that speed.
double thrust_N(const std::string& air, double speed_radps) {
  StandWorld world(stand_in(air), 1);
  for (std::int64_t t_ns = 0; t_ns <= 500'000'000; t_ns += 1'000'000) {
    io::Batch happened, sensed;
    io::ShaftState shaft;
    shaft.speed_radps = speed_radps;
    happened.add(io::Kind::shaft_state, 1, t_ns, shaft);
    world.step(t_ns, happened, sensed);
  }
  std::vector<double> values(world.signals().size());
  world.read(values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (world.signals()[i].name == "thrust") return values[i];
  }
  ADD_FAILURE() << "no thrust";
  return 0.0;
}

// Where rho n2 is the same, blades are bent and twisted alike, and the thrust differs by what the Reynolds number does.
// Densities by hand: [USSA76] table I at 1000 m; 35 degC there, and as much warmer
// down to the sea: 101 325 Pa (308.15 / 314.65)^5.25588 / (287.053 x 308.15 K).
TEST(StandAir, GivesTheThrustOfItsDynamicPressure) {
  constexpr double kUsual_kgpm3 = 1.225, kUsual_radps = 600.0;
  const double usual_N = thrust_N("", kUsual_radps);
  const auto expect = [&](const std::string& air, double density_kgpm3, double share,
                          const char* why) {
    const double faster = std::sqrt(kUsual_kgpm3 / density_kgpm3);
    EXPECT_TRUE(near(thrust_N(air, kUsual_radps * faster), usual_N, stated(share * usual_N, why)))
        << air;
  };
  expect("{}", 1.225, 0.002, "a viscosity 1 % lower");
  expect("{ above_sea = '1000 m' }", 1.1117, 0.01, "a Reynolds number 2 % lower");
  expect("{ above_sea = '1000 m', temperature = '35 degC' }", 1.02645, 0.03, "12 % lower");
}

// 500 m below the sea 31.6 degC make 1.2254 kg/m3, no less than at it, and a viscosity 4.4 % higher ([USSA76] eq. 33a, 42, 51).
TEST(StandAir, GivesLessThrustWhereItIsMoreViscous) {
  EXPECT_LT(thrust_N("{ above_sea = '-500 m', temperature = '31.6 degC' }", 600.0),
            0.997 * thrust_N("{}", 600.0));
}

TEST(StandAir, CoolsTheMotorWhereItIsSaid) {
  EXPECT_EQ(stand_in("").stage.count("ambient"), 0u);
  EXPECT_TRUE(near(stand_in("{ temperature = '35 degC' }").stage.at("ambient"), 308.15,
                   round_off(4, 308.15)));
  EXPECT_TRUE(near(stand_in("{ above_sea = '1000 m' }").stage.at("ambient"), 281.65,
                   stated(0.01, "geopotential as it is written")));
}

TEST(StandAir, BlowsFromAPlansDisturbanceOnly) {
  const auto table = lua::read_text(
      R"(return { prop = "hk_10x4.5", supply = "16 V", air = { wind_east = "1 m/s" } })",
      "plan.lua");
  const auto read = catalogue::read_stand(table.value(), "nowhere");
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().message(),
            "plan.lua:1: unknown key 'air.wind_east' (known here: above_sea, temperature)");
}

}  // namespace
}  // namespace whirl::stand

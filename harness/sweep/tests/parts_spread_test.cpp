#include "harness/sweep/parts_spread.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/near.hpp"
#include "harness/catalogue/copies.hpp"

namespace whirl::sweep {
namespace {

const std::string kTest_plans = std::string(WHIRL_ROOT) + "/test_plans/";

PartsSpread spread_of(const std::string& file, plant::ToleranceClass tolerance, int seeds) {
  const auto copies =
      catalogue::read_copies(kTest_plans + file, tolerance, kTest_plans + "propellers");
  EXPECT_TRUE(copies.ok()) << copies.error().message();
  PartsSpread spread(copies.value().numbers, copies.value().tolerance);
  for (int seed = 1; seed <= seeds; ++seed) {
    for (const DrawnPart& part : copies.value().of_seed(static_cast<std::uint64_t>(seed))) {
      spread.add(part.name, part.value);
    }
  }
  return spread;
}

const NumberSpread& row(const std::vector<NumberSpread>& rows, const std::string& name) {
  for (const NumberSpread& each : rows) {
    if (name == each.number->name) return each;
  }
  ADD_FAILURE() << name << " was not drawn";
  return rows.front();
}

TEST(PartsSpread, FourMotorsOfAHundredVehiclesAreFourHundredCopies) {
  const auto rows = spread_of("vehicles/hp_quad.lua", plant::ToleranceClass::typical, 100).rows();
  const NumberSpread& r = row(rows, "resistance");
  EXPECT_EQ(r.sums.n, 400u);
  EXPECT_TRUE(near(r.sums.mean, 0.0, stated(0.006, "three standard errors of 0.04 over 400")));
  EXPECT_TRUE(
      near(r.sums.sigma(), 0.039, stated(0.004, "0.04 cut at 2.5 sigma, three standard errors")));
  EXPECT_EQ(row(rows, "mass").sums.n, 100u);
}

TEST(PartsSpread, NoCopyLiesBeyondWhatItsClassAllows) {
  for (const char* file : {"vehicles/hp_quad.lua", "calibrations/hk_10x4.5.lua",
                           "motors/d2836_9.lua", "propellers/hk_10x4.5.lua"}) {
    for (const auto tolerance : {plant::ToleranceClass::typical, plant::ToleranceClass::worst}) {
      const auto rows = spread_of(file, tolerance, 40).rows();
      EXPECT_FALSE(rows.empty()) << file;
      for (const NumberSpread& each : rows) {
        EXPECT_GE(each.least, each.allowed.low) << file << each.number->name;
        EXPECT_LE(each.most, each.allowed.high) << file << each.number->name;
      }
    }
  }
}

TEST(PartsSpread, AMotorAloneIsNoVehicle) {
  const auto rows = spread_of("motors/d2836_9.lua", plant::ToleranceClass::typical, 3).rows();
  for (const NumberSpread& each : rows) EXPECT_STREQ(each.number->group, "motors");
  EXPECT_EQ(row(rows, "resistance").sums.n, 3u);
}

TEST(PartsSpread, TheFilesOwnClassHoldsWhereNoneIsAsked) {
  const auto copies =
      catalogue::read_copies(kTest_plans + "vehicles/hp_quad.lua", std::nullopt, "");
  ASSERT_TRUE(copies.ok());
  EXPECT_EQ(copies.value().tolerance.at("imu"), plant::ToleranceClass::typical);
}

TEST(PartsSpread, TheTableAndItsCsvHaveALineForEachNumber) {
  const PartsSpread spread = spread_of("vehicles/hp_quad.lua", plant::ToleranceClass::typical, 2);
  const std::string csv = spread.csv();
  EXPECT_EQ(spread.table().rows.size(), spread.rows().size());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'),
            static_cast<std::ptrdiff_t>(spread.rows().size()) + 1);
  EXPECT_NE(csv.find("body;mass;of its own;2;"), std::string::npos) << csv;
}

}  // namespace
}  // namespace whirl::sweep

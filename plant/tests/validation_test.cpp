#include "plant/validation/validation.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "plant/rotor/hobbyking_10x4_5.hpp"
#include "plant/rotor/polar.hpp"

namespace whirl::plant {
namespace {

std::shared_ptr<const PolarFamily> section(const std::string& file) {
  std::ifstream in(std::string(WHIRL_DATA) + "/polars/" + file);
  std::stringstream text;
  text << in.rdbuf();
  return std::make_shared<PolarFamily>(read_polar(text.str(), file).value());
}

std::shared_ptr<const Blade> hobbyking() {
  return make_blade(hobbyking_10x4_5(section("bw3.polar"), section("e63.polar"))).value();
}

void expect_within(const std::vector<Proof>& proofs) {
  ASSERT_FALSE(proofs.empty());
  for (const Proof& proof : proofs) {
    for (const Figure& figure : proof.figures) {
      EXPECT_TRUE(figure.within())
          << proof.title << ": " << figure.name << " is " << figure.measured << " " << figure.unit
          << ", limit " << figure.limit;
    }
    for (const Curve& curve : proof.model) EXPECT_EQ(curve.x.size(), curve.y.size());
  }
}

TEST(Validation, MotorMeetsItsReferences) {
  expect_within(motor_proofs(hobbyking()));
}
TEST(Validation, BatteryMeetsItsReferences) {
  expect_within(battery_proofs(hobbyking()));
}

TEST(Validation, FlightMeetsItsReferences) {
  expect_within(flight_proofs(hobbyking()));
}
TEST(Validation, AirframeMeetsItsReferences) {
  expect_within(airframe_proofs());
}
TEST(Validation, SensorsMeetTheirReferences) {
  expect_within(sensor_proofs());
}

TEST(Validation, FigureThatIsNotANumberIsNotWithin) {
  EXPECT_FALSE((Figure{"", std::nan(""), 1.0, ""}).within());
  EXPECT_FALSE((Figure{"", std::nan(""), std::numeric_limits<double>::infinity(), ""}).within());
  EXPECT_FALSE((Figure{"", -1.1, 1.0, ""}).within());
  EXPECT_TRUE((Figure{"", -0.9, 1.0, ""}).within());
}

}  // namespace
}  // namespace whirl::plant

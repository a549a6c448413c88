#include "plant/rotor/rotor.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "harness/base/near.hpp"
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
  static const auto blade =
      make_blade(hobbyking_10x4_5(section("e63.polar"), section("naca4412.polar"))).value();
  return blade;
}

RotorConditions hover(double rpm) {
  RotorConditions c;
  c.omega_radps = rpm * 3.14159265358979323846 / 30.0;
  return c;
}

TEST(Rotor, HobbykingGivesTheStaticThrustOfTheThesis) {
  const Rotor rotor(hobbyking(), 1);
  for (double rpm = 3000.0; rpm <= 5500.0; rpm += 250.0) {
    const RotorLoads got = rotor.steady(hover(rpm));
    const double want_N = 1.789e-7 * rpm * rpm - 1.4715e-4 * rpm;
    EXPECT_TRUE(near(got.thrust_N, want_N, stated(0.03 * want_N, "thesis fit against our blade")))
        << rpm;
    EXPECT_GT(got.figure_of_merit, 0.6);
    EXPECT_LT(got.figure_of_merit, 0.75);
    EXPECT_TRUE(got.validity.ok());
  }
}

TEST(Rotor, StepSettlesWhereSteadyIs) {
  Rotor rotor(hobbyking(), -1);
  const RotorConditions c = hover(4000.0);
  RotorLoads got;
  for (int i = 0; i < 2000; ++i) got = rotor.step(c, 1e-3);
  const RotorLoads want = rotor.steady(c);
  EXPECT_TRUE(near(got.thrust_N, want.thrust_N, stated(1e-6 * want.thrust_N, "settled")));
  EXPECT_TRUE(near(got.shaft_torque_Nm, want.shaft_torque_Nm,
                   stated(1e-6 * want.shaft_torque_Nm, "settled")));
}

TEST(Rotor, CounterclockwiseRotorYawsTheAirframeClockwise) {
  const RotorLoads loads = Rotor(hobbyking(), 1).steady(hover(4000.0));
  EXPECT_GT(loads.tau_P_Nm.z(), 0.0);
  EXPECT_LT(loads.f_P_N.z(), 0.0);
}

}  // namespace
}  // namespace whirl::plant

// Vehicles of any number of rotors: what holds for the quad holds for six, eight and twelve of them.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "plant/base/motor_count.hpp"
#include "plant/tests/star.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;
constexpr double kStep_s = 1e-3, kGravity_mps2 = 9.80665;

class Star : public ::testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(ManyRotors, Star, ::testing::Values(4, 6, 8, 12));

TEST_P(Star, HoversByATestControllerAndComesBackFromAPush) {
  const VehicleParams params = star(GetParam());
  ASSERT_TRUE(validate(params, "star").ok());
  Vehicle v(params, quadratic_rotors(params.airframe), 1);
  v.place({0, 0, -5}, Eigen::Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero());
  for (std::size_t i = 0; i < GetParam(); ++i) v.set_motor_speed(static_cast<int>(i), 413.0);
  const StarPilot pilot(params);
  const auto run = [&](double seconds) {
    for (int k = 0; k < std::lround(seconds / kStep_s); ++k) {
      const std::vector<double> duties = pilot.duties(5.0, v.state());
      for (std::size_t i = 0; i < GetParam(); ++i) {
        v.command(static_cast<int>(i), {duties[i], Freewheel::synchronous});
      }
      v.step(kStep_s);
    }
  };
  run(4.0);
  const VehicleState& s = v.state();
  double thrust_N = 0.0, bus_A = params.avionics_current_A;
  ASSERT_EQ(s.motors.size(), GetParam());
  for (const MotorState& m : s.motors) thrust_N += m.thrust_N, bus_A += m.bus_current_A;
  EXPECT_TRUE(near(-s.p_WB_W_m.z(), 5.0, stated(0.05, "no integral in the height law")));
  EXPECT_TRUE(near(thrust_N, params.airframe.mass_kg * kGravity_mps2, stated(0.05, "settled")));
  EXPECT_TRUE(near(s.battery_current_A, bus_A, round_off(100, bus_A)));
  const auto tilt_rad = [&] { return std::acos((s.q_WB * Vector3d::UnitZ()).z()); };
  EXPECT_LT(tilt_rad(), 0.01);

  v.place(s.p_WB_W_m, Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vector3d(1, 1, 0).normalized())),
          s.v_WB_W_mps, {0.0, 0.0, 0.5});
  run(0.05);
  EXPECT_GT(tilt_rad(), 0.1);
  run(4.0);
  EXPECT_LT(tilt_rad(), 0.01);
  EXPECT_LT(s.w_WB_B_radps.norm(), 0.02);
}

// Each rotor turns the body by its own place and sense: about x by -y, about y by x, about z by spin.
TEST_P(Star, EachMotorTurnsTheBodyAsItsPlaceSays) {
  const VehicleParams params = star(GetParam());
  for (std::size_t i = 0; i < GetParam(); ++i) {
    Vehicle v(params, quadratic_rotors(params.airframe), 1);
    v.place({0, 0, -5}, Eigen::Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero());
    for (std::size_t k = 0; k < GetParam(); ++k) {
      v.set_motor_speed(static_cast<int>(k), 413.0);
      v.command(static_cast<int>(k), {k == i ? 0.40 : 0.30, Freewheel::synchronous});
    }
    for (int k = 0; k < 100; ++k) v.step(kStep_s);
    const Vector3d& at = params.airframe.rotors[i].p_BP_B_m;
    const Vector3d want(-at.y(), at.x(), 0.0), got = v.state().w_WB_B_radps;
    EXPECT_GT(got.head<2>().dot(want.head<2>()) / (got.head<2>().norm() * want.norm()), 0.9) << i;
    EXPECT_GT(got.z() * params.airframe.rotors[i].spin, 0.0) << i;
  }
}

TEST(ManyRotors, OneToTwelveAreAVehicle) {
  EXPECT_TRUE(validate(star(1), "v").ok());
  EXPECT_TRUE(validate(star(kMostMotors), "v").ok());
  for (const std::size_t n : {std::size_t{0}, kMostMotors + 1}) {
    VehicleParams params = star(4);
    params.airframe.rotors.resize(n);
    const auto refused = validate(params, "v");
    ASSERT_FALSE(refused.ok()) << n;
    EXPECT_NE(refused.error().message().find("1 to 12 motors"), std::string::npos);
  }
}

}  // namespace
}  // namespace whirl::plant

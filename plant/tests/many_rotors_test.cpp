// Vehicles of any number of rotors: what holds for the quad holds for six, eight and twelve of them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/near.hpp"
#include "plant/base/motor_count.hpp"
#include "plant/tests/quadratic_rotor.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;
constexpr double kStep_s = 1e-3, kGravity_mps2 = 9.80665, kRadius_m = 0.3;

// Rotors at equal angles on a circle, spins by turns; each carries what each of the HP quad's does.
VehicleParams star(std::size_t rotors) {
  VehicleParams p = hp_quad();
  const auto n = static_cast<double>(rotors);
  p.airframe.mass_kg = 0.225 * n;
  p.airframe.inertia_kgm2 *= n / 4.0;
  p.airframe.rotors.clear();
  for (std::size_t i = 0; i < rotors; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / n;
    p.airframe.rotors.push_back(
        {{kRadius_m * std::cos(angle), kRadius_m * std::sin(angle), -0.03}, i % 2 == 0 ? +1 : -1});
  }
  p.battery.series_resistance_ohm *= 4.0 / n;  // so many packs side by side
  p.battery.capacity_C *= n / 4.0;
  return p;
}

// Holds height and attitude by truth: PD laws, thrusts shared out by the rotors' places.
class Pilot {
 public:
  Pilot(const VehicleParams& params, Vehicle& vehicle) : params_(params), vehicle_(vehicle) {}

  void fly(double height_m) {
    const VehicleState& s = vehicle_.state();
    const std::vector<RotorMount>& rotors = params_.airframe.rotors;
    const double n = static_cast<double>(rotors.size());
    const double mass_kg = params_.airframe.mass_kg;
    const double lift_N =
        mass_kg * (kGravity_mps2 + 4.0 * (height_m + s.p_WB_W_m.z()) + 4.0 * s.v_WB_W_mps.z());
    const Vector3d turn = 2.0 * s.q_WB.vec() * (s.q_WB.w() < 0.0 ? -1.0 : 1.0);
    const Vector3d torque_Nm =
        params_.airframe.inertia_kgm2.cwiseProduct(-36.0 * turn - 12.0 * s.w_WB_B_radps);
    for (std::size_t i = 0; i < rotors.size(); ++i) {
      const Vector3d& at = rotors[i].p_BP_B_m;
      // The sum of x^2, and of y^2, over the circle is n R^2 / 2.
      const double share = 2.0 / (n * kRadius_m * kRadius_m);
      const double thrust_N = lift_N / n +
                              share * (at.x() * torque_Nm.y() - at.y() * torque_Nm.x()) +
                              rotors[i].spin * torque_Nm.z() / (n * kTorque_per_thrust_m);
      vehicle_.command(static_cast<int>(i),
                       {duty_for(thrust_N, s.motors[i]), Freewheel::synchronous});
    }
  }

 private:
  static constexpr double kTorque_per_thrust_m = 0.016;  // of this rotor about hover

  double duty_for(double thrust_N, const MotorState& motor) const {
    double low = 0.0, high = 900.0;  // rad/s
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      (static_thrust_N(middle) < thrust_N ? low : high) = middle;
    }
    const MotorParams& m = params_.motor;
    const double volts =
        m.torque_constant_NmpA * low +
        m.resistance_ohm * (static_torque_Nm(low) / m.torque_constant_NmpA + m.no_load_current_A);
    return volts / 16.0 + 0.005 * (low - motor.speed_radps);
  }

  const VehicleParams& params_;
  Vehicle& vehicle_;
};

class Star : public ::testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(ManyRotors, Star, ::testing::Values(4, 6, 8, 12));

TEST_P(Star, HoversByATestControllerAndComesBackFromAPush) {
  const VehicleParams params = star(GetParam());
  ASSERT_TRUE(validate(params, "star").ok());
  Vehicle v(params, quadratic_rotors(params.airframe), 1);
  v.place({0, 0, -5}, Eigen::Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero());
  for (std::size_t i = 0; i < GetParam(); ++i) v.set_motor_speed(static_cast<int>(i), 413.0);
  Pilot pilot(params, v);
  const auto run = [&](double seconds) {
    for (int k = 0; k < std::lround(seconds / kStep_s); ++k) {
      pilot.fly(5.0);
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

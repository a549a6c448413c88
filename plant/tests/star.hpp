// A vehicle of any number of rotors, and who flies it in tests: he knows the truth.
#pragma once
#include <cmath>
#include <numbers>
#include <vector>

#include "plant/tests/quadratic_rotor.hpp"

namespace whirl::plant {

inline constexpr double kStarRadius_m = 0.3;

// Rotors at equal angles on a circle, spins by turns; each carries what each of the HP quad's does.
inline VehicleParams star(std::size_t rotors) {
  VehicleParams p = hp_quad();
  const auto n = static_cast<double>(rotors);
  p.airframe.mass_kg = 0.225 * n;
  p.airframe.inertia_kgm2 *= n / 4.0;
  p.airframe.rotors.clear();
  for (std::size_t i = 0; i < rotors; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / n;
    p.airframe.rotors.push_back(
        {{kStarRadius_m * std::cos(angle), kStarRadius_m * std::sin(angle), -0.03},
         i % 2 == 0 ? +1 : -1});
  }
  p.battery.series_resistance_ohm *= 4.0 / n;  // so many packs side by side
  p.battery.capacity_C *= n / 4.0;
  return p;
}

// Holds height and attitude by truth: PD laws, thrusts shared out by the rotors' places.
class StarPilot {
 public:
  explicit StarPilot(const VehicleParams& params) : params_(params) {}

  std::vector<double> duties(double height_m, const VehicleState& s) const {
    const std::vector<RotorMount>& rotors = params_.airframe.rotors;
    const double n = static_cast<double>(rotors.size());
    const double mass_kg = params_.airframe.mass_kg;
    const double lift_N =
        mass_kg * (9.80665 + 4.0 * (height_m + s.p_WB_W_m.z()) + 4.0 * s.v_WB_W_mps.z());
    const Eigen::Vector3d turn = 2.0 * s.q_WB.vec() * (s.q_WB.w() < 0.0 ? -1.0 : 1.0);
    const Eigen::Vector3d torque_Nm =
        params_.airframe.inertia_kgm2.cwiseProduct(-36.0 * turn - 12.0 * s.w_WB_B_radps);
    std::vector<double> duties;
    for (std::size_t i = 0; i < rotors.size(); ++i) {
      const Eigen::Vector3d& at = rotors[i].p_BP_B_m;
      // The sum of x^2, and of y^2, over the circle is n R^2 / 2.
      const double share = 2.0 / (n * kStarRadius_m * kStarRadius_m);
      const double thrust_N = lift_N / n +
                              share * (at.x() * torque_Nm.y() - at.y() * torque_Nm.x()) +
                              rotors[i].spin * torque_Nm.z() / (n * kTorque_per_thrust_m);
      duties.push_back(duty_for(thrust_N, s.motors[i]));
    }
    return duties;
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
};

}  // namespace whirl::plant

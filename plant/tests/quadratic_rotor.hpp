// A stand-in rotor for tests of everything but the rotor: static thrust of the 10 x 4.5 as
// [Bangura2017, 3.5] measured it, torque by a figure of merit of 0.69, no inflow, no drag.
#pragma once
#include <algorithm>
#include <cmath>

#include "plant/rotor/rotor.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {

inline double static_thrust_N(double omega_radps) {
  const double rpm = omega_radps * 30.0 / M_PI;
  return std::max(0.0, 1.789e-7 * rpm * rpm - 1.4715e-4 * rpm);
}

inline double static_torque_Nm(double omega_radps, double figure_of_merit = 0.69) {
  const double disc_m2 = M_PI * 0.127 * 0.127, thrust = static_thrust_N(omega_radps);
  const double ideal_W = thrust * std::sqrt(thrust / (2.0 * 1.225 * disc_m2));
  return omega_radps > 0.0 ? ideal_W / figure_of_merit / omega_radps : 0.0;
}

inline RotorSet quadratic_rotors(const AirframeParams& airframe) {
  RotorSet set;
  for (const RotorMount& mount : airframe.rotors) {
    set.emplace_back([spin = mount.spin](const RotorConditions& c, double) {
      RotorLoads loads;
      loads.thrust_N = static_thrust_N(c.omega_radps);
      loads.shaft_torque_Nm = static_torque_Nm(c.omega_radps);
      loads.f_P_N = {0.0, 0.0, -loads.thrust_N};
      loads.tau_P_Nm = {0.0, 0.0, spin * loads.shaft_torque_Nm};
      return loads;
    });
  }
  return set;
}

}  // namespace whirl::plant

#include "plant/motor/motor_params.hpp"

#include <cmath>

#include "plant/base/bounds.hpp"

namespace whirl::plant {

Result<Done> validate(const MotorParams& p, const std::string& place) {
  Bounds b(place);
  b.within("torque_constant_NmpA", p.torque_constant_NmpA, 1e-5, 1.0);
  b.within("resistance_ohm", p.resistance_ohm, 1e-4, 100.0);
  b.within("winding_resistance_ohm", p.winding_resistance_ohm, 0.0, p.resistance_ohm);
  b.within("inductance_H", p.inductance_H, 1e-7, 1.0);
  b.within("no_load_current_A", p.no_load_current_A, 0.0, 100.0);
  b.within("inertia_kgm2", p.inertia_kgm2, 1e-9, 1.0);
  b.within("pole_pairs", p.pole_pairs, 1, 50);
  b.within("pwm_Hz", p.pwm_Hz, 1e3, 1e6);
  b.within("diode_drop_V", p.diode_drop_V, 0.0, 3.0);
  b.within("heat_capacity_JpK", p.heat_capacity_JpK, 0.0, 1e6);
  b.within("heat_resistance_KpW", p.heat_resistance_KpW, 1e-6, 1e6);
  b.within("ambient_temp_K", p.ambient_temp_K, 200.0, 400.0);
  b.within("start_temp_K", p.start_temp_K, 200.0, 500.0);
  b.within("bearing_share", p.bearing_share, 0.0, 1.0);
  b.within("bearing_fade_K", p.bearing_fade_K, 1.0, 1e3);
  b.within("phases.sine_share", p.phases.sine_share, 0.0, 1.0);
  b.within("phases.cogging_Nm", p.phases.cogging_Nm, 0.0, 1.0);
  for (int k = 0; k < 3; ++k) {
    const std::string which = "[" + std::to_string(k) + "]";
    b.within(("phases.impedance" + which).c_str(), p.phases.impedance[k], -0.5, 0.5);
    b.within(("phases.emf" + which).c_str(), p.phases.emf[k], -0.5, 0.5);
  }
  return b.result();
}

MotorParams at_temperature(const MotorParams& cold, double temperature_K) {
  MotorParams now = cold;
  const double above_K = temperature_K - cold.winding_ref_temp_K;
  if (above_K == 0.0) return now;
  now.resistance_ohm += cold.winding_resistance_ohm * cold.copper_temp_coefficient_pK * above_K;
  const double magnets = 1.0 + cold.magnet_temp_coefficient_pK * above_K;
  const double friction = 1.0 + cold.bearing_share * std::expm1(-above_K / cold.bearing_fade_K);
  now.torque_constant_NmpA *= magnets;
  now.no_load_current_A *= friction / magnets;
  return now;
}

double winding_share(const MotorParams& cold, const MotorParams& now) {
  return 1.0 - (cold.resistance_ohm - cold.winding_resistance_ohm) / now.resistance_ohm;
}

double warmed_K(const MotorParams& cold, double temperature_K, double heat_W, double dt_s) {
  if (cold.heat_capacity_JpK <= 0.0) return temperature_K;
  const double settled_K = cold.ambient_temp_K + heat_W * cold.heat_resistance_KpW;
  const double time_s = cold.heat_capacity_JpK * cold.heat_resistance_KpW;
  return temperature_K + (settled_K - temperature_K) * -std::expm1(-dt_s / time_s);
}

}  // namespace whirl::plant

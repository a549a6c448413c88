#include "plant/motor/motor_params.hpp"

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
  return b.result();
}

}  // namespace whirl::plant

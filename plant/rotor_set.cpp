#include "plant/rotor/rotor.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {

RotorSet blade_element_rotors(std::shared_ptr<const Blade> blade, const AirframeParams& airframe) {
  RotorSet set;
  for (int i = 0; i < 4; ++i) {
    auto rotor = std::make_shared<Rotor>(blade, airframe.rotors[i].spin);
    set[i] = [rotor](const RotorConditions& c, double dt_s) { return rotor->step(c, dt_s); };
  }
  return set;
}

}  // namespace whirl::plant

#include "plant/rotor/rotor.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {

RotorSet blade_element_rotors(std::shared_ptr<const Blade> blade, const AirframeParams& airframe) {
  RotorSet set;
  for (const RotorMount& mount : airframe.rotors) {
    auto rotor = std::make_shared<Rotor>(blade, mount.spin);
    set.emplace_back(
        [rotor](const RotorConditions& c, double dt_s) { return rotor->step(c, dt_s); });
  }
  return set;
}

}  // namespace whirl::plant

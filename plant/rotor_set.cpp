#include "plant/rotor/rotor.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {

RotorSet blade_element_rotors(std::shared_ptr<const Blade> blade, const AirframeParams& airframe) {
  RotorSet set;
  for (const RotorMount& mount : airframe.rotors) {
    auto rotor = std::make_shared<Rotor>(blade, mount.spin);
    set.emplace_back([rotor, thrust = 1.0 + mount.thrust_error, torque = 1.0 + mount.torque_error](
                         const RotorConditions& c, double dt_s) {
      RotorLoads loads = rotor->step(c, dt_s);
      loads.f_P_N *= thrust;
      loads.thrust_N *= thrust;
      loads.tau_P_Nm *= torque;
      loads.shaft_torque_Nm *= torque;
      loads.shaft_power_W *= torque;
      return loads;
    });
  }
  return set;
}

}  // namespace whirl::plant

#include "plant/airframe/airframe_params.hpp"

#include "plant/base/bounds.hpp"
#include "plant/base/motor_count.hpp"

namespace whirl::plant {

Result<Done> validate(const AirframeParams& p, const std::string& place) {
  Bounds b(place);
  b.within("mass_kg", p.mass_kg, 0.01, 100.0);
  const Eigen::Vector3d& I = p.inertia_kgm2;
  for (int i = 0; i < 3; ++i) {
    b.within("inertia_kgm2", I[i], 1e-6, 100.0);
    b.require(I[i] <= I[(i + 1) % 3] + I[(i + 2) % 3],
              "inertia_kgm2: no body has one moment larger than the sum of the other two");
  }
  b.require(!p.rotors.empty() && p.rotors.size() <= kMostMotors,
            "a vehicle has 1 to " + std::to_string(kMostMotors) + " motors");
  for (const RotorMount& rotor : p.rotors) {
    b.require(rotor.spin == 1 || rotor.spin == -1, "spin of a rotor must be +1 or -1");
    b.within("radius_m of a rotor", rotor.radius_m, 0.01, 2.0);
    b.within("unbalance_kgm of a rotor", rotor.unbalance_kgm, 0.0, 1e-2);
    b.within("distance of a rotor_m", rotor.p_BP_B_m.norm(), 0.0, 5.0);
  }
  b.within("rotor_drag_spm", p.rotor_drag_spm, 0.0, 1.0);
  for (const double area : p.drag_area_m2) b.within("drag_area_m2", area, 0.0, 10.0);
  b.require(!p.contact.gear_B_m.empty(), "landing gear has no feet");
  for (const auto& foot : p.contact.gear_B_m) b.within("distance of a foot_m", foot.norm(), 0, 5);
  b.within("foot_radius_m", p.contact.foot_radius_m, 1e-3, 0.5);
  b.within("restitution", p.contact.restitution, 0.0, 1.0);
  b.within("friction", p.contact.friction, 0.0, 10.0);
  return b.result();
}

}  // namespace whirl::plant

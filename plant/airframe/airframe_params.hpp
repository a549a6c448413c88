// Mass, geometry, drag and ground contact of the airframe.
//
//   Frame    B; rotor and gear positions are from the centre of mass
//   Drag     who provides what: each rotor's own in-plane force comes from plant/rotor and acts at
//            its hub. `rotor_drag_spm` is only what the rotor model does not give of the lumped
//            0.04 s/m of [Bangura2017, 4.4], a number set by hand so that the sum is that and no
//            physics: of the HP quad the blades give 0.006, this 0.033. It acts at the hub too. Parasitic drag, of all
//            but the propellers, is -1/2 rho (cd A)_i |v| v_i along each axis of B and acts at the
//            centre of mass. A propeller that stands or windmills is the rotor model's.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::plant {

struct RotorMount {
  Eigen::Vector3d p_BP_B_m = Eigen::Vector3d::Zero();
  int spin = 1;             // +1: counter-clockwise seen from above, reaction on the body along +z
  double radius_m = 0.127;  // of the disc that may strike the ground
  double thrust_error = 0.0, torque_error = 0.0;  // shares by which this one's blades give more
  double unbalance_kgm = 0.0;  // of propeller and bell: mass x arm; what a balancer leaves is 1e-7
};

struct ContactParams {
  std::vector<Eigen::Vector3d> gear_B_m;  // centres of the feet
  double foot_radius_m = 0.01;
  double restitution = 0.3;  // of the pair of foot and ground
  double friction = 0.8;     // of the pair
};

struct AirframeParams {
  double mass_kg = 0.0;
  Eigen::Vector3d inertia_kgm2 = Eigen::Vector3d::Zero();  // principal, along the axes of B
  std::vector<RotorMount> rotors;  // 1 to kMostMotors; index: motor number - 1
  double rotor_drag_spm = 0.0;     // in-plane force = -this x thrust x air speed, per rotor
  // Drag coefficient x area seen along each axis of B.
  Eigen::Vector3d drag_area_m2 = Eigen::Vector3d::Zero();
  ContactParams contact;
};

Result<Done> validate(const AirframeParams& params, const std::string& place);

}  // namespace whirl::plant

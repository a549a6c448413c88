// Free motion of a rigid body that carries spinning rotors (a gyrostat).
//
//   Frame   W and B; `spin_B` is the angular momentum of the rotors against the body, in B
//   Method  The state is the total angular momentum in W, so without torque it stays the same to
//           round-off. Attitude by a fourth-order Runge-Kutta-Munthe-Kaas step on the rotation group
//           [Hairer2006, IV.8]. Gyroscopic torque and the reaction to a rotor's acceleration need no
//           terms of their own: they are what the momentum of the rotors leaves to the body.
//   Error   tumbling 10 s at 1 ms: energy to 1e-9, analytic solution to 1e-8 (tests/rigid_body_test)
#pragma once
#include <Eigen/Geometry>

namespace whirl::plant {

struct MassProperties {
  double mass_kg = 1.0;
  Eigen::Vector3d inertia_kgm2 = Eigen::Vector3d::Ones();  // principal, along the axes of B
};

struct BodyState {
  Eigen::Vector3d p_WB_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WB_W_mps = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d w_WB_B_radps = Eigen::Vector3d::Zero();
};

struct Forcing {                                       // held over a step
  Eigen::Vector3d f_B_N = Eigen::Vector3d::Zero();     // all but gravity, turns with the body
  Eigen::Vector3d tau_B_Nm = Eigen::Vector3d::Zero();  // about B's origin, turns with the body
  Eigen::Vector3d f_W_N = Eigen::Vector3d::Zero();     // all but gravity, fixed in W
  Eigen::Vector3d spin_start_B_Nms = Eigen::Vector3d::Zero();
  Eigen::Vector3d spin_end_B_Nms = Eigen::Vector3d::Zero();
};

BodyState step_free(const BodyState& state, const MassProperties& body, const Forcing& forcing,
                    double dt_s);

Eigen::Vector3d angular_momentum_W(const BodyState& state, const MassProperties& body,
                                   const Eigen::Vector3d& spin_B_Nms);
Eigen::Vector3d angular_acceleration_B(const BodyState& state, const MassProperties& body,
                                       const Forcing& forcing, double dt_s);  // at the step's end

}  // namespace whirl::plant

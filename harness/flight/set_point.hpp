// What the ground station commands at one instant. Frame W, SI.
#pragma once
#include <Eigen/Core>
#include <optional>

namespace whirl::flight {

struct Target {  // where the vehicle shall be
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
};

struct SetPoint {
  Target target;
  std::optional<Eigen::Vector3d> v_W_mps;  // over ground; then of the place only its height counts
};

}  // namespace whirl::flight

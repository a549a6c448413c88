// What the slow sensors see of the vehicle; filled by whoever owns the Vehicle.
#pragma once
#include <Eigen/Geometry>
#include <array>

#include "plant/base/motor_count.hpp"

namespace whirl::plant {

struct Truth {
  Eigen::Vector3d p_WB_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WB_W_mps = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_AB_B_mps = Eigen::Vector3d::Zero();  // through the air
  double static_pressure_Pa = 101325.0, air_density_kgpm3 = 1.225;
  std::array<double, kMostMotors> thrust_N{};  // of motors that are not there: 0
  std::array<double, kMostMotors> bus_current_A{};
};

}  // namespace whirl::plant

// Where a flight takes place and how it begins: what a plan says beside its vehicle.
//
//   Frame    W and B (plant/base/frames.hpp); what stands in the way and the air are the vehicle's own
//            params (plant/vehicle.hpp), the room that the cameras see is the capture's
//   Read     by harness/catalogue/surroundings_table.hpp
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace whirl::flight {

struct Start {  // in place of standing on the gear at W's origin, nose north
  Eigen::Vector3d p_WB_W_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WB_W_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB_B_radps = Eigen::Vector3d::Zero();
  double motor_speed_radps = 0.0;  // of each
};

struct Fence {  // where the vehicle shall stay; the floor is no part of it
  enum class Shape { box, cylinder };
  Shape shape = Shape::box;
  Eigen::Vector2d half_size_m = {2.5, 2.0};  // box: along north and east
  double radius_m = 0.0;                     // cylinder: about W's origin
  double height_m = 3.0;

  double margin_m(const Eigen::Vector3d& p_WB_W_m) const;  // to the nearest face; negative outside
};

struct FieldSource {  // beyond its radius its field falls with the cube of the distance
  Eigen::Vector3d field_W_T = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  double radius_m = std::numeric_limits<double>::infinity();
  std::int64_t end_ns = std::numeric_limits<std::int64_t>::max();

  Eigen::Vector3d at_W_T(const Eigen::Vector3d& p_WB_W_m) const;
};

struct Surroundings {
  std::optional<Start> start;
  std::optional<Fence> fence = Fence{};  // the room that the cameras see where nothing is said
  // Earth's field at Canberra where nothing is said.
  Eigen::Vector3d magnetic_field_W_T = {23.0e-6, 5.1e-6, -52.9e-6};
  std::vector<FieldSource> magnets;  // in the order in which the plan brings them

  Eigen::Vector3d field_W_T(const Eigen::Vector3d& p_WB_W_m, std::int64_t now_ns) const;
};

}  // namespace whirl::flight

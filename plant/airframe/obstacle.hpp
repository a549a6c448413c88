// What stands in the vehicle's way besides the floor: half-spaces (slopes, walls, a ceiling) and boxes.
//
//   Frame    W. Rigid and at rest; friction and restitution are the pair's, as the floor's
//   Error    distances in closed form; a disc against a box by 24 points of its rim and its hub: an edge
//            that enters between two of them by less than 1 % of the radius is missed
//            (tests/obstacle_test.cpp)
//   Left out what obstacles do to the air; ground effect is that of the surface straight below
#pragma once
#include <Eigen/Core>
#include <span>

namespace whirl::plant {

struct Obstacle {
  enum class Kind { half_space, box };
  Kind kind = Kind::box;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();        // a point of its face; a box's centre
  Eigen::Vector3d normal_W = -Eigen::Vector3d::UnitZ();   // half-space: out of it, of length 1
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Ones();  // box: along its own x, y, z
  double yaw_rad = 0.0;                                   // box: from north towards east
};

// The floor leaves the level at (north, east) and rises by `angle` in the direction of `towards`.
Obstacle slope(double north_m, double east_m, double towards_rad, double angle_rad);
// Upright, so far from W's origin in the direction of `towards`; the origin is on its free side.
Obstacle wall(double distance_m, double towards_rad);
Obstacle ceiling(double height_m);
// Stands on the floor, or `base_m` above it.
Obstacle box(double north_m, double east_m, double base_m, const Eigen::Vector3d& size_m,
             double yaw_rad);

double distance_m(const Obstacle& obstacle, const Eigen::Vector3d& p_W_m);  // negative inside
bool disc_enters(const Obstacle& obstacle, const Eigen::Vector3d& hub_W_m,
                 const Eigen::Vector3d& axis_W, double radius_m);
// Above the highest surface straight below: the floor's, a slope's or a box's.
double height_above_m(std::span<const Obstacle> obstacles, const Eigen::Vector3d& p_W_m);

}  // namespace whirl::plant

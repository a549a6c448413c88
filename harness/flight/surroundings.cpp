#include "harness/flight/surroundings.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::flight {

double Fence::margin_m(const Eigen::Vector3d& p_WB_W_m) const {
  const double below_top_m = height_m + p_WB_W_m.z();
  if (shape == Shape::cylinder) {
    return std::min(below_top_m, radius_m - p_WB_W_m.head<2>().norm());
  }
  const Eigen::Vector2d within_m = half_size_m - p_WB_W_m.head<2>().cwiseAbs();
  return std::min(below_top_m, within_m.minCoeff());
}

Eigen::Vector3d FieldSource::at_W_T(const Eigen::Vector3d& p_WB_W_m) const {
  const double away_m = (p_WB_W_m - p_W_m).norm();
  if (away_m <= radius_m) return field_W_T;
  return field_W_T * std::pow(radius_m / away_m, 3);
}

Eigen::Vector3d Surroundings::field_W_T(const Eigen::Vector3d& p_WB_W_m,
                                        std::int64_t now_ns) const {
  Eigen::Vector3d sum_T = magnetic_field_W_T;
  for (const FieldSource& magnet : magnets) {
    if (now_ns < magnet.end_ns) sum_T += magnet.at_W_T(p_WB_W_m);
  }
  return sum_T;
}

}  // namespace whirl::flight

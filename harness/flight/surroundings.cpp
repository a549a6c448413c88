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

}  // namespace whirl::flight

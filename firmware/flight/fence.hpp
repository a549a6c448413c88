// Where the vehicle may be: a box or a cylinder about the origin, down to the floor.
//
//   Frame   W north-east-down; `half` is half a box's width along north and east, `radius` a cylinder's,
//           `top` the height; 0 or less: no limit there
//   Use     set-points are drawn inside by kMargin_m; a vehicle that is out all the same lands, back inside
#pragma once
#include <algorithm>

#include "firmware/math.hpp"

namespace fw {

struct Fence {
  static constexpr float kMargin_m = 0.4f;  // arm and propeller

  float half_north_m = 0.0f, half_east_m = 0.0f, top_m = 0.0f, radius_m = 0.0f;

  bool contains(const Vector3& p_W_m) const {
    return within(p_W_m.x(), half_north_m) && within(p_W_m.y(), half_east_m) &&
           within(p_W_m.head<2>().norm(), radius_m) && (top_m <= 0.0f || -p_W_m.z() <= top_m);
  }
  // The nearest place that leaves the margin.
  Vector3 inside(const Vector3& p_W_m) const {
    Vector3 p = {drawn(p_W_m.x(), half_north_m), drawn(p_W_m.y(), half_east_m),
                 top_m <= 0.0f ? p_W_m.z() : std::max(p_W_m.z(), -room(top_m))};
    if (radius_m > 0.0f) p.head<2>() = clamp_norm<2>(p.head<2>(), room(radius_m));
    return p;
  }
  // The part of a horizontal velocity that can still be stopped before the margin, at `gain_ps` of what
  // is left.
  Vector3 stoppable(const Vector3& v_W_mps, const Vector3& p_W_m, float gain_ps) const {
    Vector3 v = {braked(v_W_mps.x(), p_W_m.x(), half_north_m, gain_ps),
                 braked(v_W_mps.y(), p_W_m.y(), half_east_m, gain_ps), v_W_mps.z()};
    const float from_origin_m = p_W_m.head<2>().norm();
    if (radius_m <= 0.0f || !(from_origin_m > 0.0f)) return v;
    const Eigen::Vector2f outward = p_W_m.head<2>() / from_origin_m;
    const float too_fast = outward.dot(v.head<2>()) - gain_ps * (room(radius_m) - from_origin_m);
    if (too_fast > 0.0f) v.head<2>() -= too_fast * outward;
    return v;
  }

 private:
  static float room(float limit_m) { return std::max(limit_m - kMargin_m, 0.0f); }
  static bool within(float p_m, float half_m) { return half_m <= 0.0f || std::abs(p_m) <= half_m; }
  static float drawn(float p_m, float half_m) {
    return half_m <= 0.0f ? p_m : std::clamp(p_m, -room(half_m), room(half_m));
  }
  static float braked(float v_mps, float p_m, float half_m, float gain_ps) {
    if (half_m <= 0.0f) return v_mps;
    return std::clamp(v_mps, -gain_ps * (room(half_m) + p_m), gain_ps * (room(half_m) - p_m));
  }
};

}  // namespace fw

#include "harness/flight/waypoint_flight.hpp"

#include <algorithm>

#include "base/check.hpp"

namespace whirl::flight {
namespace {

constexpr std::int64_t kFresh_ns = 200'000'000;

Eigen::Vector3d place_of(const request::Waypoint& point) {
  return {point.north_m, point.east_m, point.down_m};
}

}  // namespace

WaypointFlight::WaypointFlight(const request::Waypoints& wanted, const Target& from,
                               std::int64_t now_ns)
    : wanted_(wanted), target_(from), last_ns_(now_ns) {
  WHIRL_CHECK(!wanted.points.empty());
}

const request::Waypoint& WaypointFlight::goal() const {
  return wanted_.points[std::min(next_, wanted_.points.size() - 1)];
}

bool WaypointFlight::is_there(std::int64_t t_ns, const std::optional<CapturedPose>& seen) const {
  if (!seen || t_ns - seen->exposed_ns > kFresh_ns) return false;
  if (target_.p_W_m != place_of(goal())) return false;  // still on its way there
  return (seen->p_WB_W_m - place_of(goal())).norm() <= wanted_.within_m;
}

SetPoint WaypointFlight::at(std::int64_t t_ns, const std::optional<CapturedPose>& seen) {
  const Eigen::Vector3d left_m = place_of(goal()) - target_.p_W_m;
  const double reach_m = wanted_.speed_mps * static_cast<double>(t_ns - last_ns_) * 1e-9;
  last_ns_ = t_ns;
  if (left_m.norm() <= reach_m) {
    target_.p_W_m = place_of(goal());
  } else {
    target_.p_W_m += left_m.normalized() * reach_m;
  }
  target_.yaw_rad = goal().yaw_rad;
  if (!is_there(t_ns, seen)) {
    near_since_ns_ = -1;
  } else if (near_since_ns_ < 0) {
    near_since_ns_ = t_ns;
  }
  const double held_s =
      near_since_ns_ < 0 ? -1.0 : static_cast<double>(t_ns - near_since_ns_) * 1e-9;
  if (next_ < wanted_.points.size() && held_s >= goal().hold_s) {
    ++next_;
    near_since_ns_ = -1;
  }
  return {target_, std::nullopt};
}

}  // namespace whirl::flight

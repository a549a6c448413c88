// One waypoint after the other, as the ground station flies them: the commanded place moves straight to
// the next one at a speed; there it stays until the captured place has been near for the time to hold.
//
//   Units    SI, frame W, ns
//   Yaw      that of a waypoint is commanded from the leave of the one before on
//   Seen     a pose older than 0.2 s says nothing of where the vehicle is: it waits for the next one
#pragma once
#include <optional>

#include "harness/flight/capture.hpp"
#include "harness/flight/set_point.hpp"
#include "harness/world/request.hpp"

namespace whirl::flight {

class WaypointFlight {
 public:
  // Pre: one waypoint at least.
  WaypointFlight(const request::Waypoints& wanted, const Target& from, std::int64_t now_ns);

  // What is commanded at t_ns; in order of time. `seen`: the newest captured pose.
  SetPoint at(std::int64_t t_ns, const std::optional<CapturedPose>& seen);
  int reached() const { return static_cast<int>(next_); }  // waypoints, held included

 private:
  bool is_there(std::int64_t t_ns, const std::optional<CapturedPose>& seen) const;
  const request::Waypoint& goal() const;

  request::Waypoints wanted_;
  Target target_;
  std::size_t next_ = 0;
  std::int64_t last_ns_;
  std::int64_t near_since_ns_ = -1;  // negative: it is not near
};

}  // namespace whirl::flight

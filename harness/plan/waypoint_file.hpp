// A file of waypoints: lines of "x y z yaw [hold]", in metres, frame W (z downwards: -1.1 is 1.1 m high),
// yaw in degrees from north towards east, hold in seconds. What follows a # is for people; empty
// lines count for nothing.
//
//   Errors  bad_input with file:line: a number that is none or not finite, too few or too many of
//           them, z not above the floor, beyond 1000 m, a yaw beyond a turn, a hold beyond an hour; no
//           waypoint at all, or more than 1000
#pragma once
#include <string>
#include <vector>

#include "harness/world/request.hpp"

namespace whirl::plan {

// `name` stands in the messages.
Result<std::vector<request::Waypoint>> waypoints_of(const std::string& name,
                                                    const std::string& text);

}  // namespace whirl::plan

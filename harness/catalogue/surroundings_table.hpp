// Where a flight takes place and how it begins, from a plan's own table (test_plans/README.md lists the
// keys: start, room, outdoors, fence, obstacles, field, air, load).
//
//   Errors   bad_input, with the plan's line: a key that is wrong or unknown; a start inside the floor or
//            an obstacle
#pragma once
#include "base/result.hpp"
#include "harness/flight/flight_params.hpp"
#include "harness/lua/table.hpp"

namespace whirl::catalogue {

// `plan` is the whole table of the plan, of which the other keys have been asked for.
Result<Done> read_surroundings(const lua::Table& plan, flight::FlightParams& params);

}  // namespace whirl::catalogue

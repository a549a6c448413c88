// Who is at the other end of a bench's MAVLink, and how fast and steady it answers. Nothing is commanded: TIMESYNC is asked for.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/pacing/host_clock.hpp"
#include "harness/target/bench/bench_description.hpp"

namespace whirl::bench {

struct MavlinkCheckOptions {
  SerialLink link;
  double seconds = 5.0;  // of listening, of the host: HEARTBEAT comes once in one
  int requests = 20;
  double answer_s = 0.5;  // of the host, that one may take
};

// A line each: what comes, the period of HEARTBEAT, and what TIMESYNC takes both ways.
// Errors  bad_input: the line cannot be opened, is silent, or no MAVLink is on it, or no HEARTBEAT of an
//         autopilot; host: it was unplugged
Result<std::vector<std::string>> check_mavlink(const MavlinkCheckOptions& options,
                                               pacing::HostClock& clock);

}  // namespace whirl::bench

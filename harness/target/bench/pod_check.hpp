// Whether a pod is at the end of a bench's link, UART or CAN, and what of a still IMU's samples reaches it in time. Nothing is
// commanded: samples of a part at rest go out at 1 kHz, as in a run, and the pod's own statuses are read.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/pacing/host_clock.hpp"
#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/can_end.hpp"

namespace whirl::bench {

struct PodCheckOptions {
  PodLink link;
  double seconds =
      2.0;  // of virtual time, behind a first one in which the pod learns the way's spread
  double pace = 1.0;
};

// A line each: what it answers, what it counts, and how long the way takes; of one on CAN its bus and nodes as well
// (can_check.hpp).
// Errors  bad_input: the link cannot be opened, is silent, carries no pod's frames, or the pod hears nothing of this host;
//         host: it was unplugged
Result<std::vector<std::string>> check_pod(const PodCheckOptions& options, const CanMaker& can,
                                           pacing::HostClock& clock);

}  // namespace whirl::bench

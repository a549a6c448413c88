// The host's real-time means, where it grants them: the calling thread scheduled before all ordinary ones
// (SCHED_FIFO), the process's memory held in RAM.
//
//   Granted  to root, or by RLIMIT_RTPRIO and RLIMIT_MEMLOCK; what is refused is told with its cure, and the
//            thread goes on as it was
#pragma once
#include <string>

namespace whirl::pacing {

struct RealTime {
  bool first_in_line = false;  // SCHED_FIFO
  bool memory_held = false;
  std::string told;  // "SCHED_FIFO 50, memory locked"; or why not
};

// For the calling thread until give_back(), or the end of the process.
RealTime take_real_time();
void give_back_real_time();

}  // namespace whirl::pacing

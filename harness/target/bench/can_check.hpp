// Who is on a bench's CAN bus, and how fast and steady it answers. Nothing is commanded: GetNodeInfo is asked for.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/pacing/host_clock.hpp"
#include "io_bridges/socketcan/can_port.hpp"

namespace whirl::bench {

struct CanCheckOptions {
  std::string interface;
  std::uint32_t bit_rate_bps = 1'000'000;
  double seconds = 2.0;  // of listening, of the host
  int requests = 50;     // to each node
};

// A line for the bus, and one for each node.
// Errors  bad_input: nobody else is there, or nobody answers; host: see CanPort
Result<std::vector<std::string>> check_can_bus(io::CanPort& port, pacing::HostClock& clock,
                                               const CanCheckOptions& options);

}  // namespace whirl::bench

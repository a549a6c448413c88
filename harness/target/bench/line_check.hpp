// What can be told of a bench's serial line before a run: what comes in on it and, where its protocol answers, how soon. A board's
// command line is asked for its status; to a GPS's and a receiver's line nothing is sent.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/pacing/host_clock.hpp"
#include "harness/target/bench/bench_description.hpp"

namespace whirl::bench {

// What the board has there, or what this host plays to it.
enum class LineEnd : std::uint8_t { commands, gps, receiver };

struct LineCheckOptions {
  SerialLink link;
  LineEnd end = LineEnd::commands;
  int gps_baud = 9600;   // of the receiver that is played, as it starts
  double seconds = 2.0;  // of listening, of the host
  int requests = 20;
  double answer_s = 0.2;  // of the host, that one may take
};

// A line each: what comes, and what answers; or that nothing can be known.
// Errors  bad_input: the line cannot be opened, or made what its end needs (100000 baud 8E2); a command line that says nothing and
//         answers nothing; host: it was unplugged
Result<std::vector<std::string>> check_line(const LineCheckOptions& options,
                                            pacing::HostClock& clock);

}  // namespace whirl::bench

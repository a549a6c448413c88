// The calls of a watched function that began in a window of time.
#pragma once
#include <cstdint>
#include <vector>

#include "results/event_log.hpp"

namespace whirl::plan {

struct WatchedCalls {
  // One that still ran when the window ended.
  struct Cut {
    double lasted_s = 0.0;     // by then
    double execution_s = 0.0;  // in all; NaN of one that never returned
  };
  std::vector<std::int64_t> entries_ns;  // of all, in order but for those that never returned
  // Of those that returned within the window. Latency: NaN where no interrupt called.
  std::vector<std::int64_t> whole_ns;  // their entries
  std::vector<double> execution_s, response_s, latency_s;
  std::vector<Cut> cut;
};

WatchedCalls calls_between(const results::EventLog& events, std::uint16_t function,
                           std::int64_t from_ns, std::int64_t to_ns);

}  // namespace whirl::plan

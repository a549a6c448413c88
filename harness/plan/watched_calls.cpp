#include "harness/plan/watched_calls.hpp"

#include <cmath>

#include "harness/plan/values.hpp"

namespace whirl::plan {
WatchedCalls calls_between(const results::EventLog& events, std::uint16_t function,
                           std::int64_t from_ns, std::int64_t to_ns) {
  WatchedCalls all;
  const auto came = [&](std::int64_t entry_ns) {
    const bool within = entry_ns >= from_ns && entry_ns <= to_ns;
    if (within) all.entries_ns.push_back(entry_ns);
    return within;
  };
  if (const auto found = events.calls.find(function); found != events.calls.end()) {
    for (const auto& call : found->second) {
      if (!came(call.entry_ns)) continue;
      if (call.return_ns > to_ns) {
        all.cut.push_back({seconds(to_ns - call.entry_ns), seconds(call.execution_ns)});
        continue;
      }
      all.whole_ns.push_back(call.entry_ns);
      all.execution_s.push_back(seconds(call.execution_ns));
      all.response_s.push_back(seconds(call.return_ns - call.entry_ns));
      all.latency_s.push_back(call.latency_ns < 0 ? std::nan("") : seconds(call.latency_ns));
    }
  }
  if (const auto open = events.open_calls_ns.find(function); open != events.open_calls_ns.end()) {
    for (const std::int64_t entry_ns : open->second) {
      if (came(entry_ns)) all.cut.push_back({seconds(to_ns - entry_ns), std::nan("")});
    }
  }
  return all;
}

}  // namespace whirl::plan

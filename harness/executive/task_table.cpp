#include "harness/executive/task_table.hpp"

#include "harness/metrics/timing.hpp"

namespace whirl {
namespace {

double seconds(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-9;
}

results::TaskRow row_of(const std::string& name, const std::vector<results::CallRecord>& calls) {
  std::vector<std::int64_t> entries;
  std::vector<double> execution, response, latency;
  for (const results::CallRecord& call : calls) {
    entries.push_back(call.entry_ns);
    execution.push_back(seconds(call.execution_ns));
    response.push_back(seconds(call.return_ns - call.entry_ns));
    if (call.latency_ns >= 0) latency.push_back(seconds(call.latency_ns));
  }
  const auto period = metrics::distribution(metrics::periods_s(entries));
  const auto e = metrics::distribution(execution), r = metrics::distribution(response);
  const double latency_max = metrics::distribution(latency).max;
  return {name,  calls.size(), period.mean, period.max, e.p50,
          e.p99, e.max,        r.p99,       r.max,      latency_max};
}

}  // namespace

std::vector<results::TaskRow> task_table(const std::vector<std::string>& watch,
                                         const results::EventLog& events) {
  std::vector<results::TaskRow> rows;
  for (std::size_t number = 0; number < watch.size(); ++number) {
    const auto calls = events.calls.find(static_cast<std::uint16_t>(number));
    rows.push_back(row_of(watch[number], calls == events.calls.end()
                                             ? std::vector<results::CallRecord>{}
                                             : calls->second));
  }
  return rows;
}

}  // namespace whirl

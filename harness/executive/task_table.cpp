#include "harness/executive/task_table.hpp"

#include <nlohmann/json.hpp>

#include "base/json_text.hpp"
#include "harness/metrics/timing.hpp"

namespace whirl {
namespace {

double seconds(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-9;
}

results::TaskRow row_of(const std::string& name, const std::vector<results::CallRecord>& calls) {
  std::vector<std::int64_t> entries;
  std::vector<double> execution, response, latency, execution_cycles, response_cycles;
  for (const results::CallRecord& call : calls) {
    entries.push_back(call.entry_ns);
    execution.push_back(seconds(call.execution_ns));
    response.push_back(seconds(call.return_ns - call.entry_ns));
    if (call.latency_ns >= 0) latency.push_back(seconds(call.latency_ns));
    if (call.execution_cycles < 0) continue;
    execution_cycles.push_back(static_cast<double>(call.execution_cycles));
    response_cycles.push_back(static_cast<double>(call.response_cycles));
  }
  const auto period = metrics::distribution(metrics::periods_s(entries));
  const auto e = metrics::distribution(execution), r = metrics::distribution(response);
  const auto cycles = metrics::distribution(execution_cycles);
  results::TaskRow row;
  row.name = name;
  row.calls = calls.size();
  row.period_mean_s = period.mean;
  row.period_max_s = period.max;
  row.execution_min_s = e.min;
  row.execution_p50_s = e.p50;
  row.execution_p99_s = e.p99;
  row.execution_max_s = e.max;
  row.response_p99_s = r.p99;
  row.response_max_s = r.max;
  row.latency_max_s = metrics::distribution(latency).max;
  row.execution_min_cycles = cycles.min;
  row.execution_p50_cycles = cycles.p50;
  row.execution_p99_cycles = cycles.p99;
  row.execution_max_cycles = cycles.max;
  row.response_max_cycles = metrics::distribution(response_cycles).max;
  return row;
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

std::vector<results::InterruptRow> interrupt_table(const results::EventLog& events) {
  const auto board = parse_json(events.statistics);
  const auto handlers =
      board.is_object() ? board.value("handlers", nlohmann::json::object()) : nlohmann::json();
  std::vector<results::InterruptRow> rows;
  for (const auto& [exception, record] : events.latencies) {
    results::InterruptRow row;
    row.exception = exception;
    const auto handler = handlers.find(std::to_string(exception));
    if (handler != handlers.end() && handler->is_string()) row.handler = *handler;
    row.requests = record.count;
    row.latency_mean_s = record.sum_ns * 1e-9 / static_cast<double>(record.count);
    row.latency_max_s = record.max_ns * 1e-9;
    row.latency_max_at_s = seconds(record.max_at_ns);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace whirl

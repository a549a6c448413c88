#include "harness/metrics/timing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "harness/metrics/response.hpp"

namespace whirl::metrics {
namespace {

// The last of `times` (in order) that is not after t.
std::optional<std::int64_t> last_until(std::span<const std::int64_t> times, std::int64_t t) {
  const auto it = std::upper_bound(times.begin(), times.end(), t);
  if (it == times.begin()) return std::nullopt;
  return *std::prev(it);
}

// The last call that was entered (or, with `finished`, that had returned) by t.
const Span* last_call(std::span<const Span> calls, std::int64_t t, bool finished) {
  const auto until =
      std::upper_bound(calls.begin(), calls.end(), t, [&](std::int64_t at, const Span& call) {
        return at < (finished ? call.end_ns : call.begin_ns);
      });
  return until == calls.begin() ? nullptr : &*std::prev(until);
}

std::optional<std::int64_t> sample_behind(std::span<const std::int64_t> data_ready_ns,
                                          std::span<const std::vector<Span>> tasks,
                                          std::int64_t write_start_ns) {
  std::int64_t at = write_start_ns;
  for (std::size_t i = tasks.size(); i-- > 0;) {
    const Span* call = last_call(tasks[i], at, i + 1 != tasks.size());
    if (call == nullptr) return std::nullopt;
    at = call->begin_ns;
  }
  return last_until(data_ready_ns, at);
}

}  // namespace

Distribution distribution(std::span<const double> values) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {{}, kNaN, kNaN, kNaN, kNaN, kNaN};
  double mean = 0.0;
  for (double v : values) mean += v / static_cast<double>(values.size());
  return {values.size(),         mean,
          quantile(values, 0.0), quantile(values, 1.0),
          quantile(values, 0.5), quantile(values, 0.99)};
}

std::vector<double> periods_s(std::span<const std::int64_t> times_ns) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    periods.push_back(static_cast<double>(times_ns[i] - times_ns[i - 1]) * 1e-9);
  }
  return periods;
}

std::vector<double> deviations_s(std::span<const double> periods, double nominal_s) {
  std::vector<double> deviations;
  for (double period : periods) deviations.push_back(std::abs(period - nominal_s));
  return deviations;
}

LatencyTrace trace_latency(std::span<const std::int64_t> data_ready_ns,
                           std::span<const std::vector<Span>> tasks, std::span<const Span> writes) {
  LatencyTrace trace;
  for (const Span& write : writes) {
    if (const auto sample = sample_behind(data_ready_ns, tasks, write.begin_ns)) {
      trace.samples.push_back({write.end_ns, static_cast<double>(write.end_ns - *sample) * 1e-9});
    } else {
      ++trace.untraced;
    }
  }
  return trace;
}

}  // namespace whirl::metrics

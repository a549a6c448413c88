// When things happened: periods, spans and the path from a sensor to an actuator.
//
//   Jitter   the largest deviation of a period from nominal; p50 and p99 of the deviation beside it
//   Latency  from the data-ready of the sample that a set-point used to the STOP of the write that
//            carries it. Which sample was used follows from the tasks between: the write belongs to
//            the last call of the last task that was entered before its START; each task used what
//            the last finished call of the task before it left; the first task used the last
//            data-ready before its entry
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace whirl::metrics {

struct Distribution {
  std::size_t count = 0;
  double mean = 0, min = 0, max = 0, p50 = 0, p99 = 0;  // NaN where count is 0
};
Distribution distribution(std::span<const double> values);

struct Span {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
};

std::vector<double> periods_s(std::span<const std::int64_t> times_ns);
// |period - nominal| of each.
std::vector<double> deviations_s(std::span<const double> periods, double nominal_s);

struct LatencySample {
  std::int64_t write_ns = 0;  // STOP of the write
  double latency_s = 0;
};
// Writes that cannot be traced back to a data-ready (the first ones after boot) are counted, not
// guessed. All inputs in order of time.
struct LatencyTrace {
  std::vector<LatencySample> samples;
  std::size_t untraced = 0;
};
LatencyTrace trace_latency(std::span<const std::int64_t> data_ready_ns,
                           std::span<const std::vector<Span>> tasks, std::span<const Span> writes);

}  // namespace whirl::metrics

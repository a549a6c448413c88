// How a signal answered: the metrics of a record, each defined once and here.
//
//   Record   samples at a fixed step, from before the command (the reference) to the record's end
//   Change   from the mean of the 200 ms before the command to the mean of the record's last 200 ms
//   Times    in seconds after the command; crossings are interpolated between samples
//   Held     a value that an instrument gave stands in each row until the next one comes: crossings are interpolated
//            between the times at which it was measured, and no row is a sample of its own
//   Nothing  to measure (less than 200 ms before the command or after it, no change, a NaN among the
//            samples after the command) gives NaN, and a NaN never meets a limit
#pragma once
#include <cstdint>
#include <span>

namespace whirl::metrics {

struct Record {
  std::span<const double> values;  // one per step
  std::int64_t step_ns = 1'000'000;
  std::size_t command = 0;  // index of the sample at the command; those before it are the reference
  std::span<const std::int64_t> ages_ns = {};  // of each value, at its row's time; empty: all new
};

double rise_time_s(const Record& record);  // 10 to 90 % of a change upward; NaN for one downward
double fall_time_s(const Record& record);
double response_time_s(const Record& record);  // command to 90 % of the change, either way
double change(const Record& record);           // signed, of the means
double overshoot_ratio(const Record& record);  // beyond the final mean, 1 = 100 % of the change
// Last entry into target +- band: 0 if never outside, NaN if outside at the end.
double settled_s(const Record& record, double target, double band);
double final_mean(const Record& record);

// Over the samples from the command on.
double mean(const Record& record);
double minimum(const Record& record);
double maximum(const Record& record);
double rms_about(const Record& record, double reference);

// The p-quantile (0..1) by linear interpolation between order statistics; NaN for nothing or a NaN.
double quantile(std::span<const double> values, double p);

}  // namespace whirl::metrics

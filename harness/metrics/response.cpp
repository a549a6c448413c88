#include "harness/metrics/response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace whirl::metrics {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kReference_ns = 200'000'000;

std::span<const double> after(const Record& record) {
  return record.values.subspan(std::min(record.command, record.values.size()));
}

double mean_of(std::span<const double> values) {
  if (values.empty()) return kNaN;
  double sum = 0.0;
  for (double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

struct Change {
  double from = kNaN;
  double to = kNaN;
  double size() const { return to - from; }
  bool rises() const { return size() > 0.0; }
  // Nothing that rounding of the means could make is a change.
  bool exists() const { return std::abs(size()) > 1e-9 * std::max(std::abs(from), std::abs(to)); }
};

bool has_nan(std::span<const double> values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); });
}

Change change_of(const Record& record) {
  const auto window = static_cast<std::size_t>(kReference_ns / record.step_ns);
  const auto tail = after(record);
  if (record.command < window || tail.size() < window || has_nan(tail)) return {};
  return {mean_of(record.values.subspan(record.command - window, window)),
          mean_of(tail.last(window))};
}

// When the value of a row was measured: steps after the command.
double measured_at(const Record& record, std::size_t row) {
  const auto rows = static_cast<double>(row) - static_cast<double>(record.command);
  if (record.ages_ns.empty()) return rows;
  return rows - static_cast<double>(record.ages_ns[row]) / static_cast<double>(record.step_ns);
}

// First time after the command at which the change is done to the given share; NaN if never.
double crossing_s(const Record& record, const Change& change, double share) {
  const double level = change.from + share * change.size();
  const double sign = change.rises() ? 1.0 : -1.0;
  const double step_s = static_cast<double>(record.step_ns) * 1e-9;
  std::size_t before = record.command;
  for (std::size_t i = record.command; i < record.values.size(); ++i) {
    const double at = measured_at(record, i), since = at - measured_at(record, before);
    if (i > before && !(since > 0.0)) continue;
    const double beyond = record.values[i] - level;
    if (!(sign * beyond >= 0.0)) {
      before = i;
      continue;
    }
    if (i == record.command) return 0.0;
    const double share_back = beyond / (record.values[i] - record.values[before]);
    return step_s * std::max(0.0, at - since * share_back);
  }
  return kNaN;
}

double transition_s(const Record& record, bool rising) {
  const Change change = change_of(record);
  if (!change.exists() || change.rises() != rising) return kNaN;
  return crossing_s(record, change, 0.9) - crossing_s(record, change, 0.1);
}

double extreme(std::span<const double> values, bool largest) {
  if (values.empty() || has_nan(values)) return kNaN;
  return largest ? *std::max_element(values.begin(), values.end())
                 : *std::min_element(values.begin(), values.end());
}

}  // namespace

double rise_time_s(const Record& record) {
  return transition_s(record, true);
}

double fall_time_s(const Record& record) {
  return transition_s(record, false);
}

double response_time_s(const Record& record) {
  const Change change = change_of(record);
  return change.exists() ? crossing_s(record, change, 0.9) : kNaN;
}

double overshoot_ratio(const Record& record) {
  const Change change = change_of(record);
  if (!change.exists()) return kNaN;
  const double beyond = change.rises() ? maximum(record) - change.to : change.to - minimum(record);
  return std::max(0.0, beyond / std::abs(change.size()));
}

double change(const Record& record) {
  const Change found = change_of(record);
  return found.exists() ? found.size() : kNaN;
}

double settled_s(const Record& record, double target, double band) {
  const auto tail = after(record);
  if (tail.empty() || has_nan(tail)) return kNaN;
  const double step_s = static_cast<double>(record.step_ns) * 1e-9;
  for (std::size_t i = tail.size(); i-- > 0;) {
    if (std::abs(tail[i] - target) <= band) continue;
    return i + 1 == tail.size() ? kNaN : step_s * static_cast<double>(i + 1);
  }
  return 0.0;
}

double final_mean(const Record& record) {
  const auto window = static_cast<std::size_t>(kReference_ns / record.step_ns);
  const auto tail = after(record);
  return tail.size() < window ? kNaN : mean_of(tail.last(window));
}

double mean(const Record& record) {
  return mean_of(after(record));
}

double minimum(const Record& record) {
  return extreme(after(record), false);
}

double maximum(const Record& record) {
  return extreme(after(record), true);
}

double rms_about(const Record& record, double reference) {
  double sum = 0.0;
  const auto tail = after(record);
  for (double v : tail) sum += (v - reference) * (v - reference);
  return tail.empty() ? kNaN : std::sqrt(sum / static_cast<double>(tail.size()));
}

double quantile(std::span<const double> values, double p) {
  if (values.empty() || has_nan(values) || !(p >= 0.0 && p <= 1.0)) return kNaN;
  std::vector<double> parted(values.begin(), values.end());
  const double at = p * static_cast<double>(parted.size() - 1);
  const auto low = parted.begin() + static_cast<std::ptrdiff_t>(at);
  std::nth_element(parted.begin(), low, parted.end());
  const auto above = low + 1 == parted.end() ? low : std::min_element(low + 1, parted.end());
  return *low + (at - std::floor(at)) * (*above - *low);
}

}  // namespace whirl::metrics

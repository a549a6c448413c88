#include "harness/executive/held_pace.hpp"

#include <cstdio>

namespace whirl {

void report_pace(const HeldPace* held, double t_s, results::Report& report) {
  if (held == nullptr || held->lateness_s.empty()) return;
  report.histograms.push_back({"lateness of the host, each step", "s", held->lateness_s,
                               static_cast<double>(held->late_ns) * 1e-9});
  const auto steps = static_cast<double>(held->lateness_s.size());
  const double share = static_cast<double>(held->late_steps) / steps;
  char text[240];
  std::snprintf(text, sizeof text,
                "%lld of %zu steps (%.3g %%) later than %lld us, %.3f s given up, at %g x real "
                "time; allowed are %g %%, and nothing to be given up",
                static_cast<long long>(held->late_steps), held->lateness_s.size(), share * 100.0,
                static_cast<long long>(held->late_ns / 1000),
                static_cast<double>(held->slipped_ns) * 1e-9, held->pace, held->late_share * 100.0);
  report.log.push_back({t_s, "pacer", text});
  if (share > held->late_share || held->slipped_ns > 0) {
    report.untimely = std::string("the host was late: ") + text;
  }
}

}  // namespace whirl

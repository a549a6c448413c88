#include "harness/executive/clock_log.hpp"

#include <algorithm>
#include <cstdio>

namespace whirl {

void log_clocks(const results::EventLog& events, const std::string& who, results::Report& report) {
  for (const results::ClockRecord& record : events.clocks) {
    const io::ClockSetup& c = record.setup;
    char text[120];
    std::snprintf(text, sizeof text, "SYSCLK is %.6g MHz, HCLK %.6g, PCLK1 %.6g, PCLK2 %.6g",
                  c.sysclk_Hz * 1e-6, c.hclk_Hz * 1e-6, c.pclk1_Hz * 1e-6, c.pclk2_Hz * 1e-6);
    report.log.push_back({static_cast<double>(record.t_ns) * 1e-9, who, text});
  }
  std::stable_sort(report.log.begin(), report.log.end(),
                   [](const results::Note& a, const results::Note& b) { return a.t_s < b.t_s; });
}

}  // namespace whirl

// whirl history: trends of measured values, from results/history.sqlite.
#pragma once
#include <string>

namespace whirl::cli {

struct HistoryOptions {
  std::string plan;
  std::string expectation;
  int last = 10;
};

int history_command(const HistoryOptions& options, const std::string& results);

}  // namespace whirl::cli

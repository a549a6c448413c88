#include "harness/cli/history_command.hpp"

#include <cstdio>

#include "base/text.hpp"
#include "harness/cli/console.hpp"
#include "results/history.hpp"

namespace whirl::cli {

int history_command(const HistoryOptions& options, const std::string& results) {
  const auto rows =
      results::recall(results + "/history.sqlite", options.plan, options.expectation, options.last);
  if (!rows) return complain(rows.error());
  std::string shown, inputs;
  for (const results::PastExpectation& row : rows.value()) {
    const std::string head = printable_line(row.plan + ": " + row.name);
    if (head != shown) std::printf("%s%s\n", shown.empty() ? "" : "\n", head.c_str());
    const bool changed = head == shown && row.inputs != inputs;
    shown = head;
    inputs = row.inputs;
    std::printf("  %s  %-12s measured %-10.4g margin %-10.4g %-6s seed %s%s\n", row.when.c_str(),
                row.verdict.c_str(), row.measured, row.margin, printable_line(row.unit).c_str(),
                row.seed.c_str(), changed ? "  (other inputs than the run before)" : "");
  }
  return 0;
}

}  // namespace whirl::cli

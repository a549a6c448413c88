#include "results/spread/file_spread.hpp"

#include <filesystem>

#include "base/output_file.hpp"
#include "results/spread/overlay.hpp"

namespace whirl::results {

Result<std::string> file_spread(const std::string& folder, const std::string& name,
                                const Spread& spread, const std::vector<const SeedRun*>& runs) {
  std::error_code status;
  std::filesystem::create_directories(folder, status);
  if (status) {
    return Error{ErrorKind::host, folder, "no folder for the spread: " + status.message(), ""};
  }
  const std::string stem = folder + "/" + name;
  if (const auto csv = write_text(stem + ".csv", spread_csv(runs)); !csv) return csv.error();
  const auto charts = overlays(runs);
  if (!charts) return charts.error();
  const auto page = write_text(stem + ".html", spread_html(spread, charts.value()));
  if (!page) return page.error();
  return stem + ".html";
}

}  // namespace whirl::results

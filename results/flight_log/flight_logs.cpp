#include "results/flight_log/flight_logs.hpp"

#include <algorithm>
#include <filesystem>

#include "base/output_file.hpp"
#include "results/flight_log/card_files.hpp"
#include "results/flight_log/ulog.hpp"

namespace whirl::results {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> images_in(const std::string& folder) {
  std::vector<fs::path> images;
  std::error_code status;
  for (const auto& entry : fs::directory_iterator(folder, status)) {
    if (entry.path().extension() == ".img") images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  return images;
}

FlightLogRow describe(const fs::path& image, const CardFile& file) {
  const ULog log = read_ulog(file.bytes);
  FlightLogRow row;
  row.card = image.filename().string();
  row.name = file.name;
  row.bytes = log.records_bytes;
  row.samples = log.samples();
  row.dropouts = log.dropouts.size();
  row.closed = log.closed;
  row.from_s = static_cast<double>(log.first_us()) * 1e-6;
  row.to_s = static_cast<double>(log.last_us()) * 1e-6;
  row.damage = log.damage;
  return row;
}

}  // namespace

Result<std::vector<FlightLogRow>> copy_flight_logs(const std::string& folder) {
  std::vector<FlightLogRow> rows;
  int copies = 0;
  for (const fs::path& image : images_in(folder)) {
    const auto files = logs_on_card(image.string());
    if (!files) continue;
    for (const CardFile& file : files.value()) {
      FlightLogRow row = describe(image, file);
      if (row.bytes > 0) {
        const std::string number = ++copies == 1 ? "" : "_" + std::to_string(copies);
        row.file = "flight" + number + ".ulg";
        const std::string text(file.bytes.begin(),
                               file.bytes.begin() + static_cast<std::ptrdiff_t>(row.bytes));
        if (auto written = write_text(folder + "/" + row.file, text); !written) {
          return written.error();
        }
      }
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace whirl::results

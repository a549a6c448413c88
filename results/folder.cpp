#include "results/folder.hpp"

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>

namespace whirl::results {
namespace {

namespace fs = std::filesystem;

std::string file_name(const std::string& plan) {
  std::string name;
  for (char c : plan) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    name += plain ? c : '_';
  }
  return name.substr(0, 60);
}

std::string time_stamp() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[32];
  std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", &local);
  return text;
}

// A link that is replaced in one step, so that it always points at a whole run.
void point_latest(const fs::path& runs, const fs::path& folder) {
  std::error_code ignored;
  const fs::path fresh = runs / (".latest." + folder.filename().string());
  fs::create_directory_symlink(folder.filename(), fresh, ignored);
  fs::rename(fresh, runs / "latest", ignored);
}

}  // namespace

Result<std::string> make_run_folder(const std::string& results_root, const std::string& plan) {
  const fs::path runs = fs::path(results_root) / "runs";
  std::error_code status;
  fs::create_directories(runs, status);
  const std::string base = time_stamp() + "-" + file_name(plan);
  for (int n = 1; n < 1000; ++n) {
    const fs::path folder = runs / (n == 1 ? base : base + "-" + std::to_string(n));
    if (fs::create_directory(folder, status)) return folder.string();
    if (status) break;
  }
  return Error{ErrorKind::host, runs.string(),
               "cannot make a folder for the run: " + status.message(), ""};
}

Result<Done> write_text(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) return Error{ErrorKind::host, path, "cannot be written", "is the disk full?"};
  return Done{};
}

Result<Done> write_run(const std::string& folder, Report& report, const TruthLog& truth,
                       const EventLog& events) {
  const auto begin = std::chrono::steady_clock::now();
  const fs::path at(folder);
  for (const auto& written :
       {truth.write_csv(at / "truth.csv"), events.write_bus_csv(at / "bus.csv"),
        events.write_telemetry(at / "telemetry.tlog"),
        write_text(at / "junit.xml", junit_xml({&report})),
        write_text(at / "index.html", page_html(report, truth))}) {
    if (!written) return written.error();
  }
  report.host.results_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report.host.total_s += report.host.results_s;  // a run is not over before it is filed
  auto written = write_text(at / "run.json", run_json(report));
  if (written) point_latest(at.parent_path(), at);
  return written;
}

}  // namespace whirl::results

#include "results/folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <utility>

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

RunFolder::RunFolder(std::string runs, std::string name)
    : runs_(std::move(runs)), name_(std::move(name)) {}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : runs_(std::move(other.runs_)),
      name_(std::move(other.name_)),
      path_(std::exchange(other.path_, "")) {}

RunFolder::~RunFolder() {
  if (!path_.empty()) rmdir(path_.c_str());
}

Result<RunFolder> RunFolder::create(const std::string& results_root, const std::string& plan) {
  const fs::path runs = fs::path(results_root) / "runs";
  std::error_code status;
  fs::create_directories(runs, status);
  if (status) {
    return Error{ErrorKind::host, runs.string(), "no folder for the results: " + status.message(),
                 "--out names another place"};
  }
  RunFolder made(runs.string(), time_stamp() + "-" + file_name(plan));
  std::string path = (runs / (".unfinished-" + made.name_ + "-XXXXXX")).string();
  if (mkdtemp(path.data()) == nullptr) {
    return Error{ErrorKind::host, runs.string(),
                 std::string("no folder for the results: ") + std::strerror(errno),
                 "--out names another place"};
  }
  chmod(path.c_str(), 0755);
  made.path_ = path;
  return made;
}

Result<std::string> RunFolder::publish(const std::string& mark) {
  const std::string name = name_ + (mark.empty() ? "" : "-" + mark);
  for (int n = 1; n < 1000; ++n) {
    const fs::path to = fs::path(runs_) / (n == 1 ? name : name + "-" + std::to_string(n));
    // Not over another run's: it is never empty.
    if (std::rename(path_.c_str(), to.c_str()) == 0) {
      path_.clear();
      point_latest(runs_, to);
      return to.string();
    }
    if (errno != ENOTEMPTY && errno != EEXIST) break;
  }
  return Error{ErrorKind::host, runs_,
               std::string("the results cannot be given their name: ") + std::strerror(errno),
               "they are in " + path_};
}

Result<Done> write_text(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (out) return Done{};
  const std::string why = std::strerror(errno);
  std::error_code ignored;
  fs::remove(path, ignored);
  return Error{ErrorKind::host, path, "cannot be written: " + why, "is the disk full?"};
}

namespace {

// Writes files one after the other; one that cannot be written whole is a reason of the report.
class Filing {
 public:
  Filing(const RunFolder& folder, Report& report) : folder_(folder), report_(report) {}

  template <typename Write>
  void keep(const std::string& name, Write write) {
    const Result<Done> written = write(folder_.file(name));
    if (written) return;
    whole_ = false;
    std::error_code ignored;
    fs::remove(folder_.file(name), ignored);  // half of it would only take room
    report_.reasons.push_back({Blame::host, "results lost: " + written.error().message()});
  }
  void keep_text(const std::string& name, const std::string& text) {
    keep(name, [&](const std::string& path) { return write_text(path, text); });
  }
  bool whole() const { return whole_; }

 private:
  const RunFolder& folder_;
  Report& report_;
  bool whole_ = true;
};

}  // namespace

bool write_run(const RunFolder& folder, Report& report, const TruthLog& truth,
               const std::vector<EventLog>& logs) {
  const auto begin = std::chrono::steady_clock::now();
  Filing filing(folder, report);
  filing.keep("truth.csv", [&](const std::string& path) { return truth.write_csv(path); });
  for (const EventLog& log : logs) {
    filing.keep(log.bus_name(), [&](const std::string& path) { return log.write_bus_csv(path); });
    filing.keep(log.telemetry_name(),
                [&](const std::string& path) { return log.write_telemetry(path); });
  }
  conclude(report);  // what was lost is in what follows
  filing.keep_text("junit.xml", junit_xml({&report}));
  filing.keep_text("index.html", page_html(report, truth));
  report.host.results_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report.host.total_s += report.host.results_s;  // a run is not over before it is filed
  conclude(report);
  filing.keep_text("run.json", run_json(report));
  conclude(report);
  return filing.whole();
}

bool write_refusal(const RunFolder& folder, Report& report) {
  conclude(report);
  Filing filing(folder, report);
  filing.keep_text("junit.xml", junit_xml({&report}));
  filing.keep_text("index.html", page_html(report, TruthLog({}, 1'000'000)));
  filing.keep_text("run.json", run_json(report));
  conclude(report);
  return filing.whole();
}

}  // namespace whirl::results

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
#include <utility>

#include "base/output_file.hpp"
#include "results/sinks/replay.hpp"
#include "results/sinks/sink_types.hpp"

namespace whirl::results {
namespace {

namespace fs = std::filesystem;

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

std::string file_name(const std::string& plan) {
  std::string name;
  for (char c : plan) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    name += plain ? c : '_';
  }
  return name.substr(0, 60);
}

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

namespace {

// Writes files one after the other; one that cannot be written whole is a reason of the report.
class Filing {
 public:
  Filing(const RunFolder& folder, Report& report) : folder_(folder), report_(report) {}

  void keep(const std::string& name, const std::string& text) {
    if (const auto written = write_text(folder_.file(name), text); !written) lose(written.error());
  }
  void lose(const Error& error) {
    whole_ = false;
    report_.reasons.push_back({Blame::host, "results lost: " + error.message()});
  }
  bool whole() const { return whole_; }

 private:
  const RunFolder& folder_;
  Report& report_;
  bool whole_ = true;
};

// The files that each run has of its messages, and the curves of its page.
Curves keep_messages(const RunFolder& folder, MessageWriter& messages, Filing& filing) {
  Curves curves(messages.head().columns, messages.head().step_ns, messages.rows());
  if (const auto written = messages.finish(); !written) {
    filing.lose(written.error());
    return curves;
  }
  std::vector<SinkType> types;
  for (const SinkType& type : sink_types()) {
    if (type.in_each_run) types.push_back(type);
  }
  const auto made = replay(folder.messages(), folder.path(), types, {&curves});
  if (!made) {
    filing.lose(made.error());
    return curves;
  }
  for (const Error& lost : made.value().lost) filing.lose(lost);
  if (made.value().damage) filing.lose(*made.value().damage);
  return curves;
}

void keep_flight_logs(const RunFolder& folder, Report& report, Filing& filing) {
  auto copied = copy_flight_logs(folder.path());
  if (!copied) return filing.lose(copied.error());
  report.flight_logs = std::move(copied.value());
}

void keep_page(const Report& report, const Curves& curves, Filing& filing) {
  filing.keep("junit.xml", junit_xml({&report}));
  filing.keep("index.html", page_html(report, curves));
}

}  // namespace

bool write_run(const RunFolder& folder, Report& report, MessageWriter& messages) {
  const auto begin = std::chrono::steady_clock::now();
  Filing filing(folder, report);
  const Curves curves = keep_messages(folder, messages, filing);
  keep_flight_logs(folder, report, filing);
  conclude(report);  // what was lost is in what follows
  keep_page(report, curves, filing);
  report.host.results_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report.host.total_s += report.host.results_s;  // a run is not over before it is filed
  conclude(report);
  filing.keep("run.json", run_json(report));
  conclude(report);
  return filing.whole();
}

bool write_refusal(const RunFolder& folder, Report& report) {
  conclude(report);
  Filing filing(folder, report);
  keep_page(report, Curves(), filing);
  filing.keep("run.json", run_json(report));
  conclude(report);
  return filing.whole();
}

}  // namespace whirl::results

#include "harness/cli/parser_fuzzers.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

#include "base/argv.hpp"
#include "base/result.hpp"
#include "base/whole_file.hpp"
#include "harness/cli/console.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;

// What the runs of one parser came to.
struct Outcome {
  std::string runs = "-", per_second = "-", inputs_kept = "-";
  std::string finding;  // empty: none
};

struct Parser {
  std::string name, program, seeds, dictionary, grown, findings, log;
};

Result<std::vector<Parser>> find_parsers(const ParserFuzzOptions& options) {
  const fs::path build =
      options.build.empty() ? fs::path(options.root) / "build/fuzz" : fs::path(options.build);
  const fs::path sources = fs::path(options.root) / "harness/fuzz";
  std::vector<Parser> parsers;
  std::error_code status;
  for (const auto& entry : fs::directory_iterator(sources / "corpus", status)) {
    const std::string name = entry.path().filename();
    const bool wanted = options.only.empty() || std::find(options.only.begin(), options.only.end(),
                                                          name) != options.only.end();
    if (!wanted) continue;
    const fs::path dictionary = sources / (name + ".dict");
    parsers.push_back({name, build / ("harness/fuzz/fuzz_" + name), entry.path(),
                       fs::exists(dictionary, status) ? dictionary.string() : "",
                       build / "corpus" / name, build / "findings" / (name + "-"),
                       build / "logs" / (name + ".log")});
    if (!fs::exists(parsers.back().program, status)) {
      return Error{
          ErrorKind::bad_input, parsers.back().program, "is not built",
          options.build.empty() ? "./whirl fuzz builds it" : "./whirl fuzz --smoke builds it"};
    }
  }
  if (parsers.size() < std::max<std::size_t>(1, options.only.size())) {
    return Error{ErrorKind::bad_input, sources / "corpus", "holds no such parser", ""};
  }
  std::sort(parsers.begin(), parsers.end(),
            [](const Parser& a, const Parser& b) { return a.name < b.name; });
  return parsers;
}

std::vector<std::string> arguments(const Parser& p, const ParserFuzzOptions& o) {
  std::vector<std::string> all{p.program,
                               "-seed=" + std::to_string(o.seed),
                               "-timeout=20",
                               "-rss_limit_mb=2048",
                               "-malloc_limit_mb=512",
                               "-max_len=4096",
                               "-print_final_stats=1",
                               "-artifact_prefix=" + p.findings};
  all.push_back(o.runs > 0 ? "-runs=" + std::to_string(o.runs)
                           : "-max_total_time=" + std::to_string(std::lround(o.seconds)));
  if (!p.dictionary.empty()) all.push_back("-dict=" + p.dictionary);
  all.push_back(p.grown);
  all.push_back(p.seeds);
  return all;
}

// Its words go to the log. Returns the status of waitpid; -1: it could not be started.
int run(const Parser& p, const ParserFuzzOptions& options) {
  std::vector<std::string> words = arguments(p, options);
  std::vector<char*> argv = argv_of(words);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, p.log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  pid_t pid = 0;
  const int started = posix_spawn(&pid, p.program.c_str(), &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  int status = -1;
  if (started != 0 || waitpid(pid, &status, 0) != pid) return -1;
  return status;
}

// The word behind a mark in libFuzzer's log; "-" where it is not.
std::string behind(const std::string& log, const std::string& mark) {
  const auto at = log.find(mark);
  if (at == std::string::npos) return "-";
  const auto first = log.find_first_not_of(" \t", at + mark.size());
  return first == std::string::npos ? "-"
                                    : log.substr(first, log.find_first_of(" \n", first) - first);
}

Outcome outcome_of(const Parser& p, int status) {
  const auto log = read_whole_file(p.log);
  const std::string text = log ? log.value() : "";
  Outcome o{behind(text, "stat::number_of_executed_units:"),
            behind(text, "stat::average_exec_per_sec:"), behind(text, "stat::new_units_added:"),
            ""};
  if (status == 0) return o;
  o.finding = behind(text, "Test unit written to");
  if (o.finding == "-") o.finding = "ended with status " + std::to_string(status) + ": " + p.log;
  return o;
}

Result<Done> make_folders(const Parser& p) {
  std::error_code status;
  for (const fs::path& folder :
       {fs::path(p.grown), fs::path(p.findings).parent_path(), fs::path(p.log).parent_path()}) {
    fs::create_directories(folder, status);
    if (status) return Error{ErrorKind::host, folder, status.message(), ""};
  }
  return Done{};
}

// As many at a time as there are cores; a row when one has ended.
int run_all(const std::vector<Parser>& parsers, const ParserFuzzOptions& options) {
  std::atomic<std::size_t> next = 0;
  std::mutex printing;
  int code = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < parsers.size(); i = next++) {
      const Parser& p = parsers[i];
      const Outcome o = outcome_of(p, run(p, options));
      const std::lock_guard lock(printing);
      if (!o.finding.empty()) code = 1;
      std::printf("%-20s %12s %10s %8s  %s\n", p.name.c_str(), o.runs.c_str(), o.per_second.c_str(),
                  o.inputs_kept.c_str(), o.finding.empty() ? "none" : o.finding.c_str());
      std::fflush(stdout);
    }
  };
  std::vector<std::jthread> workers;
  for (unsigned n = std::max(1u, std::thread::hardware_concurrency()); n > 0; --n) {
    workers.emplace_back(work);
  }
  workers.clear();  // each has ended
  return code;
}

}  // namespace

int run_parser_fuzzers(const ParserFuzzOptions& options) {
  const auto parsers = find_parsers(options);
  if (!parsers) return complain(parsers.error());
  // Paths in findings read alike wherever it is called from.
  std::error_code status;
  fs::current_path(options.root, status);
  if (status) return complain({ErrorKind::host, options.root, status.message(), ""});
  std::printf("%-20s %12s %10s %8s  %s\n", "parser", "inputs", "per second", "new", "finding");
  for (const Parser& p : parsers.value()) {
    if (const auto made = make_folders(p); !made) return complain(made.error());
  }
  return run_all(parsers.value(), options);
}

}  // namespace whirl::cli

#include "harness/cli/outcomes.hpp"
#include "base/output_file.hpp"

#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "results/folder.hpp"
#include "results/history.hpp"
#include "results/spread/file_spread.hpp"
#include "results/spread/limits.hpp"

namespace whirl::cli {
namespace {

void print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

results::Report without_run(const std::string& plan, const std::string& file,
                            const results::Reason& why) {
  results::Report report;
  report.plan = plan;
  report.file = file;
  report.reasons.push_back(why);
  results::conclude(report);
  return report;
}

results::Blame blame_for(int code) {
  switch (code) {
    case 1:
      return results::Blame::firmware;
    case 2:
      return results::Blame::user;
    case 3:
      return results::Blame::host;
    default:
      return results::Blame::harness;
  }
}

}  // namespace

void Outcomes::add(const Finished& finished, const std::string& text, const std::string& run_json) {
  const results::Report& report = finished.report;
  int code = results::exit_code(report);
  // The line in the history is a result: without it a pass is not one.
  const auto kept = results::remember(results_ + "/history.sqlite", report);
  if (!kept) {
    std::fprintf(stderr, "whirl: %s\n", kept.error().message().c_str());
    code = code == 0 ? 3 : code;
  }
  print(json_ ? run_json : text);
  file(finished, code);
}

void Outcomes::add_refused(const Error& error) {
  const std::string file_name = error.place.substr(0, error.place.find(':'));
  file({without_run(file_name.empty() ? "whirl run" : file_name, file_name,
                    results::reason_of(error)),
        ""},
       complain(error));
}

void Outcomes::add_lost(const std::string& plan, const std::string& file_name, int code,
                        const std::string& what) {
  const Finished lost{without_run(plan, file_name, {blame_for(code), what}), ""};
  print(outcome(lost));
  file(lost, code);
}

// What only the merged files show must not fill the memory of a night of runs.
void Outcomes::file(const Finished& finished, int code) {
  tally_.add(code);
  runs_.push_back({finished.report, finished.folder});
  results::Report& report = runs_.back().report;
  report.histograms.clear();
  report.statistics_json.clear();
  report.boards.clear();
}

// A plan whose runs were lost before they had a seed has none.
void Outcomes::file_spreads() {
  std::map<std::pair<std::string, std::string>, std::vector<const results::SeedRun*>> plans;
  for (const results::SeedRun& run : runs_) {
    if (!run.report.digest.empty()) plans[{run.report.file, run.report.plan}].push_back(&run);
  }
  std::set<std::string> taken;
  for (const auto& [plan, runs] : plans) {
    if (runs.size() < 2) continue;
    // Of two plans whose names are one in the names of files, the second has a number.
    std::string name = results::file_name(plan.second);
    if (name.starts_with('.')) name.front() = '_';
    std::string own = name;
    for (int n = 2; !taken.insert(own).second; ++n) own = name + "-" + std::to_string(n);
    const results::Spread spread = results::spread_of(runs);
    const auto filed = results::file_spread(results_ + "/seeds", own, spread, runs);
    if (!filed) {
      tally_.worsen(complain(filed.error()));
    } else if (!json_) {
      print(results::spread_text(spread) + "  " + shown_path(filed.value()) + "\n");
    }
    if (limits_margin_ > 0.0) {
      print(results::limits_text(results::propose_limits(runs, limits_margin_), limits_margin_));
    }
  }
}

int Outcomes::finish() {
  std::vector<const results::Report*> all;
  all.reserve(runs_.size());
  for (const results::SeedRun& run : runs_) all.push_back(&run.report);
  std::error_code ignored;
  std::filesystem::create_directories(results_, ignored);
  const auto written = write_text(results_ + "/junit.xml", results::junit_xml(all));
  if (!written) tally_.worsen(complain(written.error()));
  file_spreads();
  if (!json_ && tally_.plans() > 1) print(tally_.summary());
  return tally_.code();
}

}  // namespace whirl::cli

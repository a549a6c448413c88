#include "harness/cli/outcomes.hpp"
#include "base/output_file.hpp"

#include <cstdio>
#include <filesystem>

#include "harness/cli/console.hpp"
#include "results/folder.hpp"
#include "results/history.hpp"

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

void Outcomes::add(const results::Report& report, const std::string& text,
                   const std::string& run_json) {
  int code = results::exit_code(report);
  // The line in the history is a result: without it a pass is not one.
  const auto kept = results::remember(results_ + "/history.sqlite", report);
  if (!kept) {
    std::fprintf(stderr, "whirl: %s\n", kept.error().message().c_str());
    code = code == 0 ? 3 : code;
  }
  print(json_ ? run_json : text);
  file(report, code);
}

void Outcomes::add_refused(const Error& error) {
  const std::string file_name = error.place.substr(0, error.place.find(':'));
  file(without_run(file_name.empty() ? "whirl run" : file_name, file_name,
                   results::reason_of(error)),
       complain(error));
}

void Outcomes::add_lost(const std::string& plan, const std::string& file_name, int code,
                        const std::string& what) {
  const results::Report report = without_run(plan, file_name, {blame_for(code), what});
  print(outcome({report, ""}));
  file(report, code);
}

// What only the merged file shows must not fill the memory of a night of runs.
void Outcomes::file(const results::Report& report, int code) {
  tally_.add(code);
  reports_.push_back(report);
  reports_.back().histograms.clear();
  reports_.back().statistics_json.clear();
}

int Outcomes::finish() {
  std::vector<const results::Report*> all;
  all.reserve(reports_.size());
  for (const results::Report& report : reports_) all.push_back(&report);
  std::error_code ignored;
  std::filesystem::create_directories(results_, ignored);
  const auto written = write_text(results_ + "/junit.xml", results::junit_xml(all));
  if (!written) tally_.worsen(complain(written.error()));
  if (!json_ && tally_.plans() > 1) print(tally_.summary());
  return tally_.code();
}

}  // namespace whirl::cli

// What came out of the plans of one command: told, counted, in the history, and merged in one junit.xml.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/cli/run_one.hpp"
#include "harness/cli/tally.hpp"
#include "results/spread/spread.hpp"

namespace whirl::cli {

class Outcomes {
 public:
  // results: the folder of runs, where history and the merged junit.xml go.
  // limits_margin: of limits proposed from several seeds (results/spread/limits.hpp); 0: none are.
  Outcomes(std::string results, bool json, double limits_margin)
      : results_(std::move(results)), json_(json), limits_margin_(limits_margin) {}

  // What is printed is the report's run.json, or `text`.
  void add(const Finished& finished, const std::string& text, const std::string& run_json);
  // A plan file that cannot be read: a testcase, and the error on standard error.
  void add_refused(const Error& error);
  void add_not_run(std::size_t plans) { tally_.add_not_run(plans); }
  // Of a process without a report: told, and a testcase, all the same.
  void add_lost(const std::string& plan, const std::string& file, int code,
                const std::string& what);

  // Writes RESULTS/junit.xml, of plans that ran on several seeds their spread (RESULTS/seeds/PLAN.html and
  // .csv), says what came of all, and gives the exit code.
  int finish();

 private:
  void file(const Finished& finished, int code);
  void file_spreads();

  std::string results_;
  bool json_;
  double limits_margin_;
  Tally tally_;
  std::vector<results::SeedRun> runs_;
};

}  // namespace whirl::cli

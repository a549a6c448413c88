// One run as data: what a parent hands to the process that does it, and what comes back.
//
//   Job      JSON {"file", "plan", "seed", "set": [{"key", "value"}], "results", "keep", "twice", "calibrations"};
//            "seed" is null for the plan's own
//   Report   JSON {"exit_code", "folder", "outcome", "run"}: `run` is the text of run.json, `outcome` what
//            people read of it
//   Errors   internal, where a text is not what the other side writes
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "base/setting.hpp"

namespace whirl {

struct Job {
  std::string file, plan;
  std::optional<std::uint64_t> seed;
  Settings settings;
  std::string results;  // folder of runs and history
  bool keep = false, twice = false;
  std::string calibrations;
};

struct JobReport {
  int exit_code = 4;
  std::string folder;   // of the run; empty: it could not be made
  std::string outcome;  // for people
  std::string run;      // run.json
};

std::string job_text(const Job& job);
Result<Job> read_job(std::string_view text);
std::string job_report_text(const JobReport& report);
Result<JobReport> read_job_report(std::string_view text);

}  // namespace whirl

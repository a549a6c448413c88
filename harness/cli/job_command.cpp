#include "harness/cli/job_command.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/memory_file.hpp"
#include "harness/cli/run_one.hpp"
#include "harness/job/job.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

RunOptions options_of(const Job& job) {
  RunOptions options;
  options.paths = {job.file};
  options.only = job.plan;
  options.seed = job.seed;
  options.settings = job.settings;
  options.keep = job.keep;
  options.twice = job.twice;
  options.calibrations = job.calibrations;
  options.out = job.results;
  return options;
}

}  // namespace

int job_command(const Composition& composition) {
  std::string text;
  if (!read_whole(STDIN_FILENO, text)) {
    return complain(
        {ErrorKind::host, "job", std::string("cannot be read: ") + std::strerror(errno), ""});
  }
  const auto job = read_job(text);
  if (!job) return complain(job.error());
  Composition here = composition;
  here.results = job.value().results;
  const RunOptions options = options_of(job.value());
  const FoundPlans found = find_plans(options, here.root);
  if (!found.errors.empty()) return complain(found.errors.front());
  const Finished finished = run_one(found.plans.front(), options, here, nullptr);
  const int code = results::exit_code(finished.report);
  const std::string told = outcome(finished);
  const std::string report =
      job_report_text({code, finished.folder, told, results::run_json(finished.report)});
  if (write_whole(kReport_fd, report)) return code;
  std::printf("%s       its report is lost: %s\n", told.c_str(), std::strerror(errno));
  return code;
}

}  // namespace whirl::cli

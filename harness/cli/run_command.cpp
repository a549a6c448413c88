#include "harness/cli/run_command.hpp"

#include <cstdio>

#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/jobs.hpp"
#include "results/folder.hpp"
#include "results/history.hpp"

namespace whirl::cli {
namespace {

struct Tally {
  int code = 0;
  int passed = 0, failed = 0, inconclusive = 0, errors = 0;

  void add(const results::Report& report) {
    code = results::worse_exit_code(code, results::exit_code(report));
    switch (report.verdict) {
      case results::Verdict::pass:
        ++passed;
        break;
      case results::Verdict::fail:
        ++failed;
        break;
      case results::Verdict::inconclusive:
        ++inconclusive;
        break;
      case results::Verdict::error:
        ++errors;
        break;
    }
  }
};

// In this process, one after the other.
Tally run_here(const std::vector<PlanChoice>& plans, const RunOptions& options,
               const Composition& composition) {
  Tally tally;
  for (const PlanChoice& choice : plans) {
    const Finished finished = run_one(choice, options, composition, progress_line(choice.name));
    clear_progress();
    tally.add(finished.report);
    if (!finished.folder.empty()) {
      const auto kept = results::remember(composition.results + "/history.sqlite", finished.report);
      if (!kept) std::fprintf(stderr, "whirl: %s\n", kept.error().message().c_str());
    }
    if (options.json) {
      std::fputs(results::run_json(finished.report).c_str(), stdout);
    } else {
      std::fputs(outcome(finished).c_str(), stdout);
    }
    std::fflush(stdout);
  }
  return tally;
}

}  // namespace

int run_command(const RunOptions& options, const Composition& composition) {
  const FoundPlans found = find_plans(options, composition.root);
  int code = 0;
  for (const Error& error : found.errors) {
    code = results::worse_exit_code(code, complain(error));
  }
  if (options.gdb && found.plans.size() > 1) {
    std::fprintf(stderr, "whirl: --gdb wants one plan, not %zu (name it, or use --only)\n",
                 found.plans.size());
    return 2;
  }
  if (options.jobs > 1 && found.plans.size() > 1) {
    return results::worse_exit_code(code, run_in_processes(found.plans, options));
  }
  const Tally tally = run_here(found.plans, options, composition);
  if (!options.json && found.plans.size() > 1) {
    std::fputs(summary(tally.passed, tally.failed, tally.inconclusive, tally.errors).c_str(),
               stdout);
  }
  return results::worse_exit_code(code, tally.code);
}

int list_command(const RunOptions& options, const Composition& composition) {
  const FoundPlans found = find_plans(options, composition.root);
  for (const PlanChoice& plan : found.plans) {
    std::string tags;
    for (const std::string& tag : plan.tags) tags += (tags.empty() ? "" : ", ") + tag;
    std::printf("%-44s %-10s %-14s %s%s\n", plan.name.c_str(), plan.image.c_str(),
                plan.vehicle.c_str(), plan.file.c_str(),
                tags.empty() ? "" : ("  [" + tags + "]").c_str());
  }
  for (const Error& error : found.errors) {
    std::fprintf(stderr, "whirl: %s\n", error.message().c_str());
  }
  return found.errors.empty() ? 0 : 2;
}

}  // namespace whirl::cli

#include "harness/cli/run_command.hpp"

#include <cstdio>

#include "base/interruption.hpp"
#include "harness/cli/bench_choice.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/jobs.hpp"
#include "harness/cli/outcomes.hpp"
#include "harness/cli/run_one.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

// In this process, one after the other.
void run_here(const std::vector<PlanChoice>& plans, const RunOptions& options,
              const Composition& composition, Outcomes& outcomes) {
  for (std::size_t i = 0; i < plans.size(); ++i) {
    if (interrupted_by() != 0) return outcomes.add_not_run(plans.size() - i);
    const Finished finished = run_one(plans[i], options, composition, progress_line(plans[i].name));
    clear_progress();
    outcomes.add(finished, outcome(finished),
                 options.json ? results::run_json(finished.report) : "");
  }
}

}  // namespace

int run_command(const RunOptions& options, const Composition& composition) {
  if (const auto good = check_bench_options(options); !good) return complain(good.error());
  if (const auto good = check_copper_options(options); !good) return complain(good.error());
  const FoundPlans found = find_plans(options, composition.root);
  if (!options.copper.empty() && found.plans.size() > 1) {
    return complain({ErrorKind::bad_input, "--copper",
                     "is a capture of one run, and " + std::to_string(found.plans.size()) +
                         " plans are asked for",
                     "name one, or use --only"});
  }
  if (options.gdb && found.plans.size() > 1) {
    std::fprintf(stderr, "whirl: --gdb wants one plan, not %zu (name it, or use --only)\n",
                 found.plans.size());
    return 2;
  }
  Outcomes outcomes(composition.results, options.json, options.limits_margin);
  for (const Error& error : found.errors) outcomes.add_refused(error);
  if (options.jobs > 1 && found.plans.size() > 1) {
    run_in_processes(found.plans, options, composition.results, outcomes);
  } else {
    run_here(found.plans, options, composition, outcomes);
  }
  return outcomes.finish();
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

#include "harness/cli/run_command.hpp"

#include <cstdio>

#include "base/interruption.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/jobs.hpp"
#include "harness/cli/tally.hpp"
#include "results/folder.hpp"
#include "results/history.hpp"

namespace whirl::cli {
namespace {

// True: it is in the history.
bool remember(const results::Report& report, const Composition& composition) {
  const auto kept = results::remember(composition.results + "/history.sqlite", report);
  if (!kept) std::fprintf(stderr, "whirl: %s\n", kept.error().message().c_str());
  return kept.ok();
}

// In this process, one after the other.
void run_here(const std::vector<PlanChoice>& plans, const RunOptions& options,
              const Composition& composition, Tally& tally) {
  for (std::size_t i = 0; i < plans.size(); ++i) {
    if (interrupted_by() != 0) return tally.add_not_run(plans.size() - i);
    const Finished finished = run_one(plans[i], options, composition, progress_line(plans[i].name));
    clear_progress();
    int code = results::exit_code(finished.report);
    // The line in the history is a result: without it a pass is not one.
    if (!finished.folder.empty() && !remember(finished.report, composition)) {
      code = code == 0 ? 3 : code;
    }
    tally.add(code);
    const std::string text = options.json ? results::run_json(finished.report) : outcome(finished);
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
  }
}

}  // namespace

int run_command(const RunOptions& options, const Composition& composition) {
  const FoundPlans found = find_plans(options, composition.root);
  Tally tally;
  for (const Error& error : found.errors) tally.add(complain(error));
  if (options.gdb && found.plans.size() > 1) {
    std::fprintf(stderr, "whirl: --gdb wants one plan, not %zu (name it, or use --only)\n",
                 found.plans.size());
    return 2;
  }
  if (options.jobs > 1 && found.plans.size() > 1) {
    run_in_processes(found.plans, options, tally);
  } else {
    run_here(found.plans, options, composition, tally);
  }
  if (!options.json && found.plans.size() + found.errors.size() > 1) {
    std::fputs(tally.summary().c_str(), stdout);
  }
  return tally.code();
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

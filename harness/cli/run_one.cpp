#include "harness/cli/run_one.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/interruption.hpp"
#include "base/mishap.hpp"
#include "base/places.hpp"
#include "harness/cli/find_file.hpp"
#include "harness/cli/versions.hpp"
#include "io_bridges/board_description/board_text.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

using results::RunFolder;

void announce_gdb(const Setup& setup) {
  std::fprintf(
      stderr,
      "whirl: the board waits for gdb; the world's time stands still while it is stopped:\n"
      "       gdb-multiarch %s -ex 'target remote 127.0.0.1:%d'\n",
      setup.image.c_str(), setup.gdb_port);
}

Result<RunRecord> run_record(const PlanChoice& choice, const RunOptions& options,
                             const Composition& composition, const ProgressSink& progress) {
  // Loaded anew: no run sees what another left in its Lua.
  auto file = plan::PlanFile::load(choice.file);
  if (!file) return file.error();
  const plan::Plan* plan = nullptr;
  for (const plan::Plan& p : file.value()->plans()) {
    if (p.name == choice.name) plan = &p;
  }
  WHIRL_CHECK(plan != nullptr, choice.name);

  const std::string& root = composition.root;
  const Asker who{plan->file, plan->place};
  const auto board_path = find_file(plan->board, who, {root + "/test_plans/boards"}, ".lua");
  if (!board_path) return board_path.error();
  auto board = read_board(shown_path(board_path.value()));
  if (!board) return board.error();
  for (const std::string& function : plan->watch) {
    if (board.value().watch_number(function) < 0) board.value().watch.push_back(function);
  }
  const auto image = find_file(plan->image, who, image_folders(root), ".elf");
  if (!image) return image.error();

  Setup setup{*plan,
              board.value(),
              root,
              image.value(),
              "",
              options.seed.value_or(plan->seed),
              options.gdb ? options.gdb_port : 0};
  if (!plan->vehicle.empty()) {
    const auto vehicle = find_file(plan->vehicle, who, {root + "/test_plans/vehicles"}, ".lua");
    if (!vehicle) return vehicle.error();
    setup.vehicle_file = shown_path(vehicle.value());
  }
  auto world = composition.world(setup);
  if (!world) return world.error();
  auto target = composition.target(setup);
  if (!target) return target.error();
  if (options.gdb) announce_gdb(setup);
  RunRecord record = execute(
      {*file.value(), *plan, board.value(), *world.value(), *target.value(), setup.seed}, progress);
  add_files(record.report.versions, {{"image", setup.image},
                                     {"plan", plan->file},
                                     {"board", board.value().file},
                                     {"vehicle", setup.vehicle_file}});
  add_host(record.report.versions, root);
  record.board_text = board_text(
      {board.value(), {.image = setup.image, .seed = setup.seed, .gdb_port = setup.gdb_port}});
  return record;
}

// --twice: the second run must cross the boundary with the very same bytes. Its own verdict counts
// as the first one's does; a run that was cut off shows nothing of the digest.
void add_second_run(const results::Report& second, results::Report& report) {
  results::Expectation e;
  e.name = "two runs give the same digest";
  e.how = "holds";
  e.note = report.digest + " and " + second.digest;
  e.measured = e.margin = std::nan("");
  const auto cut_off = [](const results::Report& r) {
    return r.verdict != results::Verdict::pass && r.blame != results::Blame::firmware &&
           r.blame != results::Blame::not_shown;
  };
  e.verdict = report.digest == second.digest       ? results::Verdict::pass
              : cut_off(report) || cut_off(second) ? results::Verdict::inconclusive
                                                   : results::Verdict::fail;
  report.expectations.push_back(e);
  if (second.verdict != results::Verdict::pass && second.reason != report.reason) {
    report.reasons.push_back({second.blame, "in the second run: " + second.reason});
  }
}

results::Report refused(const PlanChoice& choice, const RunOptions& options, const Error& error) {
  results::Report report;
  report.plan = choice.name;
  report.file = choice.file;
  report.tags = choice.tags;
  report.seed = options.seed.value_or(0);
  report.reasons.push_back(results::reason_of(error));
  results::conclude(report);
  return report;
}

void run_again(const PlanChoice& choice, const RunOptions& options, const Composition& composition,
               const ProgressSink& progress, results::Report& report) {
  const auto again = run_record(choice, options, composition, progress);
  if (again) return add_second_run(again.value().report, report);
  report.reasons.push_back(results::reason_of(again.error(), "in the second run: "));
}

// Gives the folder its name. Whatever goes wrong while it is written is a reason beside those of the run.
template <typename Write>
Finished file(RunFolder& folder, results::Report report, Write write) {
  std::string path;
  try {
    const bool whole = write(report);
    const auto published = folder.publish(interrupted_by() != 0 ? "interrupted"
                                          : whole               ? ""
                                                                : "incomplete");
    if (published) path = published.value();
    if (!published) report.reasons.push_back(results::reason_of(published.error()));
  } catch (...) {
    report.reasons.push_back(results::reason_of(error_of_current_exception(), "results lost: "));
  }
  results::conclude(report);
  return {std::move(report), path};
}

Finished file_run(RunFolder& folder, RunRecord record, const RunOptions& options) {
  return file(folder, std::move(record.report), [&](results::Report& report) {
    bool whole = results::write_run(folder, report, record.truth, record.events);
    if (options.keep) {
      const auto kept = results::write_text(folder.file("board.json"), record.board_text);
      whole = whole && kept.ok();
      if (!kept) report.reasons.push_back(results::reason_of(kept.error()));
    }
    return whole;
  });
}

Finished file_refusal(RunFolder& folder, results::Report report) {
  return file(folder, std::move(report),
              [&folder](results::Report& filed) { return results::write_refusal(folder, filed); });
}

}  // namespace

Finished run_one(const PlanChoice& choice, const RunOptions& options,
                 const Composition& composition, const ProgressSink& progress) {
  try {
    auto folder = RunFolder::create(composition.results, choice.name);
    if (!folder) return {refused(choice, options, folder.error()), ""};
    auto record = run_record(choice, options, composition, progress);
    if (!record) return file_refusal(folder.value(), refused(choice, options, record.error()));
    results::Report& report = record.value().report;
    if (options.twice && interrupted_by() == 0) {
      try {
        run_again(choice, options, composition, progress, report);
      } catch (...) {
        report.reasons.push_back(results::reason_of(error_of_current_exception()));
      }
    }
    results::conclude(report);
    return file_run(folder.value(), std::move(record.value()), options);
  } catch (...) {
    return {refused(choice, options, error_of_current_exception()), ""};
  }
}

}  // namespace whirl::cli

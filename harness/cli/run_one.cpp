#include "harness/cli/run_one.hpp"

#include <cstdio>
#include <filesystem>

#include "harness/cli/find_file.hpp"
#include "harness/cli/versions.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;

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
  const auto image = find_file(plan->image, who,
                               {root + "/build/firmware", root + "/build/firmware/images"}, ".elf");
  if (!image) return image.error();

  Setup setup{*plan,
              board.value(),
              root,
              image.value(),
              "",
              "",
              options.seed.value_or(plan->seed),
              options.gdb ? options.gdb_port : 0};
  if (!plan->vehicle.empty()) {
    const auto vehicle = find_file(plan->vehicle, who, {root + "/test_plans/vehicles"}, ".lua");
    if (!vehicle) return vehicle.error();
    setup.vehicle_file = shown_path(vehicle.value());
  }
  setup.board_text = board_json(
      board.value(),
      {.image = setup.image, .seed = setup.seed, .gdb = options.gdb, .gdb_port = setup.gdb_port});
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
  record.board_text = setup.board_text;
  return record;
}

// --twice: the second run must cross the boundary with the very same bytes.
void compare_digests(const RunRecord& first, results::Report& report) {
  results::Expectation e;
  e.name = "two runs give the same digest";
  e.how = "holds";
  e.verdict =
      first.report.digest == report.digest ? results::Verdict::pass : results::Verdict::fail;
  e.note = first.report.digest + " and " + report.digest;
  report.expectations.push_back(e);
  if (e.verdict == results::Verdict::fail && report.verdict == results::Verdict::pass) {
    report.verdict = results::Verdict::fail;
    report.reason = "two runs differ: digests " + e.note;
  }
}

results::Report refused(const PlanChoice& choice, const RunOptions& options, const Error& error) {
  results::Report report;
  report.plan = choice.name;
  report.file = choice.file;
  report.tags = choice.tags;
  report.seed = options.seed.value_or(0);
  report.verdict =
      error.kind == ErrorKind::host ? results::Verdict::inconclusive : results::Verdict::error;
  report.bad_input = error.kind == ErrorKind::bad_input;
  report.reason = error.message();
  return report;
}

}  // namespace

Finished run_one(const PlanChoice& choice, const RunOptions& options,
                 const Composition& composition, const ProgressSink& progress) {
  auto record = run_record(choice, options, composition, progress);
  if (!record) return {refused(choice, options, record.error()), ""};
  results::Report& report = record.value().report;
  if (options.twice) {
    auto again = run_record(choice, options, composition, progress);
    if (!again) return {refused(choice, options, again.error()), ""};
    compare_digests(again.value(), report);
  }
  const auto folder = results::make_run_folder(composition.results, choice.name);
  if (!folder) return {refused(choice, options, folder.error()), ""};
  const auto written =
      results::write_run(folder.value(), report, record.value().truth, record.value().events);
  if (!written) return {refused(choice, options, written.error()), ""};
  if (options.keep) {
    const auto kept =
        results::write_text(folder.value() + "/board.json", record.value().board_text);
    if (!kept) return {refused(choice, options, kept.error()), ""};
  }
  return {std::move(report), folder.value()};
}

}  // namespace whirl::cli

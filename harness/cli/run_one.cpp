#include "harness/cli/run_one.hpp"
#include "harness/cli/bench_choice.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>

#include "base/interruption.hpp"
#include "base/mishap.hpp"
#include "base/output_file.hpp"
#include "base/places.hpp"
#include "harness/cli/board_wires.hpp"
#include "harness/cli/find_board.hpp"
#include "harness/cli/find_file.hpp"
#include "harness/cli/versions.hpp"
#include "harness/plan/needs.hpp"
#include "harness/target/node_set.hpp"
#include "io_bridges/board_description/board_text.hpp"
#include "io_bridges/board_description/bus_kind.hpp"
#include "io_bridges/board_description/bus_name.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

using results::RunFolder;

void announce_gdb(const Setup& setup) {
  const std::string& node = setup.plan.nodes[setup.node].name;
  std::fprintf(
      stderr,
      "whirl: the board%s waits for gdb; the world's time stands still while it is stopped:\n"
      "       gdb-multiarch %s -ex 'target remote 127.0.0.1:%d'\n",
      node.empty() ? "" : (" " + node).c_str(), setup.image.c_str(), setup.gdb_port);
}

Result<Node> read_node(const plan::PlanNode& wanted, const Asker& who, const std::string& root) {
  auto board = find_board(wanted.board, who, root);
  if (!board) return board.error();
  for (const std::string& function : wanted.watch) {
    if (board.value().watch_number(function) < 0) board.value().watch.push_back(function);
  }
  return Node{wanted.name, std::move(board.value())};
}

// All that a run needs, from the names in its plan.
struct Prepared {
  std::vector<Node> nodes;
  std::vector<Setup> setups;                       // of the nodes
  std::unique_ptr<bench::BenchDescription> bench;  // the setups point at it; null: none
  std::unique_ptr<World> world;
  std::unique_ptr<Target> target;

  BoardStart start_of(std::size_t node) const {
    const Setup& s = setups[node];
    return {nodes[node].board,
            {.image = s.image, .flashed = s.flashed, .seed = s.seed, .gdb_port = s.gdb_port}};
  }
};

// The part of a board that speaks on that UART to the world outside; null: none does.
const BoardDevice* serial_on(const BoardDescription& board, std::uint16_t uart) {
  for (const BoardDevice& device : board.devices) {
    const bool on_it = is_uart(device.bus) && bus_number(device.bus) == uart;
    if (device.type == "serial" && on_it) return &device;
  }
  return nullptr;
}

// Each end is a serial line of its own, of one rate.
Result<Done> check_wires(const plan::Plan& plan, const std::vector<Node>& nodes) {
  const auto wrong = [&plan](const std::string& what, const std::string& cure) {
    return Error{ErrorKind::bad_input, plan.place, "wires: " + what, cure};
  };
  std::set<std::pair<std::size_t, std::uint16_t>> used;
  for (const plan::PlanWire& wire : plan.wires) {
    std::optional<KeyValue> bauds[2];
    for (const auto& [end, baud] : {std::pair{wire.a, &bauds[0]}, std::pair{wire.b, &bauds[1]}}) {
      const Node& node = nodes[end.node];
      const std::string name = node.name + ".usart" + std::to_string(end.uart);
      const BoardDevice* serial = serial_on(node.board, end.uart);
      if (serial == nullptr) {
        return wrong(name + " has no serial device on " + node.board.name,
                     "a wire is joined where the board file has one");
      }
      if (!used.insert({end.node, end.uart}).second) {
        return wrong(name + " is wired twice", "a UART has one other end");
      }
      *baud = serial->value("baud");
    }
    if (bauds[0] != bauds[1]) {
      return wrong(nodes[wire.a.node].name + " and " + nodes[wire.b.node].name +
                       " speak at different rates: on copper that is garbage",
                   "");
    }
  }
  return Done{};
}

// One board's target stands for itself.
Result<std::unique_ptr<Target>> make_target(const plan::Plan& plan,
                                            const std::vector<Setup>& setups,
                                            std::vector<BoardWireLink> links,
                                            const Composition& composition) {
  std::vector<NodeSet::Entry> entries;
  for (const Setup& setup : setups) {
    auto target = composition.target(setup);
    if (!target) return target.error();
    if (plan.nodes.size() == 1) return std::move(target.value());
    entries.push_back({plan.nodes[setup.node].name, std::move(target.value())});
  }
  std::vector<UartWire> wires;
  for (const plan::PlanWire& wire : plan.wires) {
    wires.push_back({{wire.a.node, wire.a.uart}, {wire.b.node, wire.b.uart}});
  }
  return std::unique_ptr<Target>(
      std::make_unique<NodeSet>(std::move(entries), std::move(wires), std::move(links)));
}

// Who names the file under this key: the plan, or the command line in its place.
Asker asker_of(const std::string& key, const plan::Plan& plan, const Settings& settings) {
  for (const Setting& setting : settings) {
    if (setting.key == key) return {plan.file, "the command line's " + key};
  }
  return {plan.file, plan.place};
}

// The node that --gdb holds: the only one, or the one that is named.
Result<std::size_t> held_by_gdb(const plan::Plan& plan, const RunOptions& options) {
  if (!options.gdb || (plan.nodes.size() == 1 && options.gdb_board.empty())) return std::size_t{0};
  std::string names;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    if (!options.gdb_board.empty() && plan.nodes[i].name == options.gdb_board) return i;
    names += (names.empty() ? "" : ", ") + plan.nodes[i].name;
  }
  if (plan.nodes.size() == 1) {
    return Error{ErrorKind::bad_input, plan.place, "--gdb-board: this plan has one board", ""};
  }
  return Error{ErrorKind::bad_input, plan.place,
               options.gdb_board.empty() ? "--gdb holds one board, and this plan has several"
                                         : "--gdb-board: no board '" + options.gdb_board + "'",
               "--gdb-board with one of " + names};
}

// `folder`: where the parts of the boards leave their files; empty: nowhere.
Result<Prepared> prepare(const plan::Plan& plan, const PlanChoice& choice,
                         const RunOptions& options, const Composition& composition,
                         const std::string& folder) {
  const std::string& root = composition.root;
  const auto who = [&](const char* key) { return asker_of(key, plan, options.settings); };
  std::string vehicle_file;
  for (const Setting& setting : options.settings) {
    if (!plan.vehicle.empty() || path_in(setting, "vehicle").empty()) continue;
    return Error{ErrorKind::bad_input, plan.place,
                 "--set " + setting.key + ": this plan has a stand and no vehicle", ""};
  }
  if (!plan.vehicle.empty()) {
    const auto vehicle =
        find_file(plan.vehicle, who("plan.vehicle"), {root + "/test_plans/vehicles"}, ".lua");
    if (!vehicle) return vehicle.error();
    vehicle_file = shown_path(vehicle.value());
  }
  const auto held = held_by_gdb(plan, options);
  if (!held) return held.error();
  Settings settings = plan.vehicle_settings;
  settings.insert(settings.end(), options.settings.begin(), options.settings.end());
  Prepared all;
  all.nodes.reserve(plan.nodes.size());  // the setups point at them
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    auto node = read_node(plan.nodes[i], who("plan.board"), root);
    if (!node) return node.error();
    const auto image =
        find_file(plan.nodes[i].image, who("plan.image"), image_folders(root), ".elf");
    if (!image) return image.error();
    all.nodes.push_back(std::move(node.value()));
    const int port = options.gdb && held.value() == i ? options.gdb_port : 0;
    all.setups.push_back({plan, i, all.nodes.back().board, root, image.value(), vehicle_file,
                          choice.seed.value_or(plan.seed), port, settings, folder});
    all.setups.back().world_may_stand = options.gdb;
    all.setups.back().copper = options.copper;
    all.setups.back().copper_rate_Hz = options.copper_rate_Hz;
    for (const std::string& cells : plan.nodes[i].flash) {
      const auto file = find_file(cells, who("plan.flash"), image_folders(root), ".elf");
      if (!file) return file.error();
      all.setups.back().flashed.push_back(file.value());
    }
  }
  if (const auto joined = check_wires(plan, all.nodes); !joined) return joined.error();
  if (const auto led = check_board_wires(plan, all.nodes); !led) return led.error();
  note_joined(plan, all.nodes);
  if (!options.copper.empty() && plan.nodes.size() > 1) {
    return Error{ErrorKind::bad_input, plan.place,
                 "--copper is of one board, and this plan has several", ""};
  }
  if (!options.target.empty()) {
    auto bench = bench_for(plan, all.nodes, options, root);
    if (!bench) return bench.error();
    all.bench = std::make_unique<bench::BenchDescription>(std::move(bench.value()));
    for (Setup& setup : all.setups) setup.bench = all.bench.get();
  }
  auto links = join_boards(plan, all.nodes, all.setups);
  if (!links) return links.error();
  auto world = composition.world(all.setups.front());
  if (!world) return world.error();
  all.world = std::move(world.value());
  auto target = make_target(plan, all.setups, std::move(links.value()), composition);
  if (!target) return target.error();
  all.target = std::move(target.value());
  if (const auto met = plan::check_offers(plan, all.target->offers()); !met) return met.error();
  return all;
}

// What went into the run: files by role, and on which machine.
void add_versions(const Prepared& prepared, const plan::Plan& plan, const std::string& root,
                  RunRecord& record) {
  for (const Setup& setup : prepared.setups) {
    const Node& node = prepared.nodes[setup.node];
    add_files(record.report.versions,
              {{node.qualified("image"), setup.image}, {node.qualified("board"), node.board.file}});
    for (const std::string& cells : setup.flashed) {
      add_files(record.report.versions, {{node.qualified("flashed"), cells}});
    }
    record.board_texts.emplace_back(node.name, board_text(prepared.start_of(setup.node)));
  }
  for (const Setting& setting : prepared.setups.front().settings) {
    record.report.versions.emplace_back("set " + setting.key, setting.value);
  }
  add_files(record.report.versions,
            {{"plan", plan.file}, {"vehicle", prepared.setups.front().vehicle_file}});
  add_host(record.report.versions, root);
}

// What each seed's own ESC was told by `whirl calibrate esc --seed`, in place of the constants that plans share.
Result<plan::PlanFile::Instead> own_calibration(const RunOptions& options, std::uint64_t seed) {
  namespace fs = std::filesystem;
  if (options.calibrations.empty()) return plan::PlanFile::Instead{};
  const fs::path folder = (fs::path(options.calibrations) / "").parent_path();
  const std::string path = folder / ("seed_" + std::to_string(seed)) / "constants.lua";
  const std::string name = folder.filename();
  if (fs::is_regular_file(path)) return plan::PlanFile::Instead{name + "_calibration.lua", path};
  return Error{ErrorKind::bad_input, path,
               "is not there: the ESC of seed " + std::to_string(seed) + " was not calibrated",
               "whirl calibrate esc test_plans/calibrations/" + name + ".lua --seed " +
                   std::to_string(seed)};
}

// `folder`: where its messages are written; null: nowhere.
Result<RunRecord> run_record(const PlanChoice& choice, const RunOptions& options,
                             const Composition& composition, const ProgressSink& progress,
                             const RunFolder* folder, const Company* company = nullptr) {
  // Loaded anew: no run sees what another left in its Lua.
  const auto own = own_calibration(options, choice.seed.value_or(1));
  if (!own) return own.error();
  auto file = plan::PlanFile::load(choice.file, {}, options.settings, own.value());
  if (!file) return file.error();
  const plan::Plan* plan = nullptr;
  for (const plan::Plan& p : file.value()->plans()) {
    if (p.name == choice.name) plan = &p;
  }
  WHIRL_CHECK(plan != nullptr, choice.name);
  auto prepared =
      prepare(*plan, choice, options, composition, folder == nullptr ? "" : folder->path());
  if (!prepared) return prepared.error();
  const Prepared& parts = prepared.value();
  for (const Setup& setup : parts.setups) {
    if (setup.gdb_port != 0) announce_gdb(setup);
  }
  const std::uint64_t seed = parts.setups.front().seed;
  std::optional<results::MessageWriter> messages;
  if (folder != nullptr) {
    messages.emplace(folder->messages(), run_head(*plan, parts.nodes, *parts.world, seed));
  }
  RunRecord record =
      execute({*file.value(), *plan, parts.nodes, *parts.world, *parts.target, seed,
               messages ? &*messages : nullptr, folder == nullptr ? "" : folder->path(),
               company == nullptr ? nullptr : &company->companion},
              progress);
  record.messages = std::move(messages);
  add_versions(parts, *plan, composition.root, record);
  if (!own.value().path.empty()) {
    add_files(record.report.versions, {{own.value().file_name, own.value().path}});
  }
  if (company != nullptr && folder != nullptr) {
    const auto left =
        company->leave(folder->path(), record.report, *plan, file.value()->sandbox().files_below());
    if (!left) record.report.reasons.push_back(results::reason_of(left.error(), "results lost: "));
  }
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

results::Report refused(const PlanChoice& choice, const Error& error) {
  results::Report report;
  report.plan = choice.name;
  report.file = choice.file;
  report.tags = choice.tags;
  report.seed = choice.seed.value_or(0);
  report.reasons.push_back(results::reason_of(error));
  results::conclude(report);
  return report;
}

void run_again(const PlanChoice& choice, const RunOptions& options, const Composition& composition,
               const ProgressSink& progress, results::Report& report) {
  const auto again = run_record(choice, options, composition, progress, nullptr);
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
    bool whole = results::write_run(folder, report, *record.messages);
    if (options.keep) {
      for (const auto& [node, text] : record.board_texts) {
        const std::string name = "board" + (node.empty() ? "" : "_" + node) + ".json";
        const auto kept = write_text(folder.file(name), text);
        whole = whole && kept.ok();
        if (!kept) report.reasons.push_back(results::reason_of(kept.error()));
      }
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
                 const Composition& composition, const ProgressSink& progress,
                 const Company* company) {
  try {
    auto folder = RunFolder::create(composition.results, choice.name);
    if (!folder) return {refused(choice, folder.error()), ""};
    auto record = run_record(choice, options, composition, progress, &folder.value(), company);
    if (!record) return file_refusal(folder.value(), refused(choice, record.error()));
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
    return {refused(choice, error_of_current_exception()), ""};
  }
}

}  // namespace whirl::cli

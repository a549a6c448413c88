#include "harness/cli/run_words.hpp"

#include "harness/cli/option_quantity.hpp"
#include "harness/cli/seeds.hpp"

namespace whirl::cli {
namespace {

// "vehicle.motor.inertia=3e-5": of a plan, its stand or its vehicle.
std::string setting_complaint(const std::string& text) {
  const Setting setting{text.substr(0, text.find('=')), ""};
  bool known = text.find('=') != std::string::npos;
  known = known && !(path_in(setting, "plan").empty() && path_in(setting, "stand").empty() &&
                     path_in(setting, "vehicle").empty());
  return known ? "" : "'" + text + "' is no plan.KEY=VALUE, stand.KEY=VALUE or vehicle.KEY=VALUE";
}

Error twice(const std::string& key, const std::string& other) {
  return {ErrorKind::bad_input, "", "--set " + key + ": is set by " + other + " already", ""};
}

}  // namespace

void add_plan_options(CLI::App& command, RunOptions& options) {
  command.add_option("plans", options.paths, "plan files or folders (default: test_plans)");
  command.add_option("--tag", options.tag, "only plans with this tag");
  command.add_option("--only", options.only, "only the plan of this name");
}

std::string seed_complaint(const std::string& text) {
  const auto seed = read_seed(text);
  return seed ? "" : seed.error().what;
}

std::string seeds_complaint(const std::string& text) {
  const auto seeds = read_seeds(text);
  return seeds ? "" : seeds.error().what;
}

RunCommand::RunCommand(CLI::App& app) {
  auto* run = app.add_subcommand("run", "run plans; exit code 0 only if all pass");
  add_plan_options(*run, options);
  auto* one = run->add_option("--seed", seed, "instead of the plans' own seeds");
  one->check(seed_complaint);
  run->add_option("--seeds", seeds_,
                  "each plan on each of these (2..21, or 1,4,10..12), and their spread at the end")
      ->check(seeds_complaint)
      ->excludes(one);
  run->add_option("--jobs,-j", options.jobs, "so many plans at once")->check(CLI::Range(1, 256));
  run->add_flag("--gdb", options.gdb, "open a gdb port and hold the world's time while gdb holds");
  run->add_option("--gdb-board", options.gdb_board,
                  "of a plan of several boards: which one gdb holds")
      ->needs("--gdb");
  run->add_option("--gdb-port", options.gdb_port, "instead of 1234")
      ->check(CLI::Range(1024, 65535));
  run->add_flag("--keep", options.keep, "keep what went into the board's process as well");
  run->add_flag("--twice", options.twice, "run twice and expect the same digest");
  run->add_flag("--json", options.json, "run.json on standard output");
  run->add_option("--set", settings_,
                  "KEY=VALUE in place of what a file says: "
                  "vehicle.motor.resistance=\"90 mohm\", stand.supply=\"15 V\", "
                  "plan.timeout=\"9 s\"")
      ->check(setting_complaint)
      ->allow_extra_args(false);
  run->add_option("--out", options.out, "where runs and the history go (default: results)");
  run->add_option(
      "--calibrations", options.calibrations,
      "results/calibrations/NAME: what `whirl calibrate esc --seed` found of each seed's ESC, in "
      "place of NAME_calibration.lua");
  auto* target = run->add_option("--target", options.target,
                                 "bench/NAME: a physical board, as test_plans/benches/NAME.lua "
                                 "describes it (default: the virtual board)");
  run->add_option("--arm", options.arm, "the phrase of the bench's safety")->needs(target);
  auto* copper = run->add_option("--copper", options.copper,
                                 "judge buses and pins by this capture of the same run (.vcd of "
                                 "whirl export, .sr of an analyser)");
  copper->excludes(target);
  run->add_option("--copper-rate", copper_rate_,
                  "how often a .vcd is looked at: \"50 MHz\" (four times the fastest clock)")
      ->needs(copper);
}

void RunCommand::add_limits(CLI::App& app) {
  limits_ = app.add_subcommand("limits", "limits for a plan's lines, from its spread over seeds");
  add_plan_options(*limits_, options);
  limits_->add_option("--seeds", seeds_, "1..20, or 1,4,10..12")
      ->check(seeds_complaint)
      ->required();
  limits_->add_option("--margin", margin_, "beyond the worst of them (default 30 %)");
  limits_->add_option("--jobs,-j", options.jobs, "so many plans at once")
      ->check(CLI::Range(1, 256));
  limits_->add_option("--calibrations", options.calibrations, "as of whirl run");
  limits_->add_option("--out", options.out, "where the runs go (default: results)");
}

Result<Done> RunCommand::parse_texts() {
  if (!seed.empty()) options.seed = read_seed(seed).value();
  if (!seeds_.empty()) options.seeds = read_seeds(seeds_).value();
  if (!options.calibrations.empty() && !options.seed && options.seeds.empty()) {
    return Error{ErrorKind::bad_input, "--calibrations", "are of seeds: say which",
                 "--seed or --seeds"};
  }
  if (*limits_) options.limits_margin = 0.3;
  auto read =
      read_within(margin_, Dimension::ratio, "--margin", "1 %", "1000 %", options.limits_margin);
  if (!read) return read;
  read = read_within(copper_rate_, Dimension::frequency, "--copper-rate", "1 kHz", "1000 MHz",
                     options.copper_rate_Hz);
  return read ? read_settings() : read;
}

Result<Done> RunCommand::read_settings() {
  for (const std::string& text : settings_) {
    const Setting setting{text.substr(0, text.find('=')), text.substr(text.find('=') + 1)};
    for (const Setting& other : options.settings) {
      if (other.key == setting.key) return twice(setting.key, "--set " + setting.key);
    }
    const bool is_seed = setting.key == "plan.seed";
    if (is_seed && options.seed) return twice(setting.key, "--seed");
    if (is_seed && !options.seeds.empty()) return twice(setting.key, "--seeds");
    options.settings.push_back(setting);
  }
  return Done{};
}

}  // namespace whirl::cli

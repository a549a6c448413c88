// The command line. CLI11 stays in this file, run_words and bench_words: its header is a heavy one.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <tuple>

#include "base/mishap.hpp"
#include "base/units.hpp"
#include "harness/cli/bench_command.hpp"
#include "harness/cli/bench_words.hpp"
#include "harness/cli/calibrate_command.hpp"
#include "harness/cli/composition.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/decode_command.hpp"
#include "harness/cli/devices_command.hpp"
#include "harness/cli/doctor.hpp"
#include "harness/cli/export_command.hpp"
#include "harness/cli/fly_command.hpp"
#include "harness/cli/fuzz_command.hpp"
#include "harness/cli/history_command.hpp"
#include "harness/cli/job_command.hpp"
#include "harness/cli/page_command.hpp"
#include "harness/cli/run_command.hpp"
#include "harness/cli/run_words.hpp"

#ifndef WHIRL_VERSION
#define WHIRL_VERSION "unknown"
#endif

namespace whirl::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  whirl run                                    every plan below test_plans/
  whirl run test_plans/flight/hover.lua        one file
  whirl run test_plans/flight --tag quick      the quick ones of a folder
  whirl run test_plans/flight/hover.lua --seed 7 --twice
  whirl run test_plans/flight/gust_crossing.lua --seeds 2..21 --jobs 2
                                               mean, spread and worst, and a page of all laid over
  whirl limits test_plans/flight/hover.lua --seeds 1..20
                                               limits that a small regression would break
  whirl run test_plans/flight/hover.lua --gdb  then: gdb-multiarch build/firmware/flight.elf
  whirl run test_plans/bench --target bench/esc_stand --arm "the propeller is clear"
                                               the same plan on a physical board, in real time
  whirl standin esc32v2                        a virtual board as if it were metal, for a bench to find
  whirl fly --pace 1                           a flight in real time for QGroundControl or another
                                               MAVLink client, on UDP 127.0.0.1:14550
  whirl list                                   what plans there are
  whirl sweep test_plans/vehicles/hp_quad.lua  motor, propeller and hover point in figures and curves
  whirl validate                               the plant over its reference points
  whirl validate prop.lua points_5000.txt      a propeller over its own measured points
  whirl validate --timing                      cycles of instructions, against the data sheets
  whirl calibrate esc test_plans/calibrations/hk_10x4.5.lua
                                               constants of an ESC, its motor and its propeller
  whirl calibrate bound test_plans/calibrations/hk_10x4.5.lua
                                               which inflow that ESC can tell from power at best
  whirl history hover                          how the margins went, run by run
  whirl export results/runs/latest --csv       every message that crossed, with its fields, as text
  whirl fuzz --smoke                           random registers, images and files, for bugs of whirl
  whirl devices                                what a board file's devices may be, key by key
  whirl doctor                                 what is missing on this machine

Exit codes: 0 pass, 1 a plan failed, 2 bad input or usage, 3 inconclusive (the host was at fault, the
run was interrupted, or what the plan asks was not shown), 4 internal error; of several plans the
worst counts: 4, then 2, 1, 3, 0. A flight of `whirl fly` that ended in order is 0, without a verdict.
Results: results/runs/latest/index.html, run.json, junit.xml, messages.whirl (all that crossed), and
of it truth.csv, bus.csv, telemetry.tlog (serial.txt on a stand), bus_NODE.csv of boards with names;
of --seeds results/seeds/PLAN.html and PLAN.csv)";

// Its seed, --out and --target are parsed as those of `whirl run`.
CLI::App* add_fly(CLI::App& app, FlyOptions& options, RunCommand& run) {
  auto* fly = app.add_subcommand(
      "fly", "a flight paced to real time, for a MAVLink client on UDP; gives no verdict");
  // A range does not keep NaN out.
  const CLI::Validator finite(
      [](const std::string& text) {
        return text.find_first_of("nN") == std::string::npos ? "" : "is not a finite number";
      },
      "FINITE");
  fly->add_option("plan", options.plan, "vehicle, surroundings and script (default: free.lua)");
  fly->add_option("--only", run.options.only, "the plan of this name");
  fly->add_option("--udp", options.udp, "HOST:PORT where the client listens (127.0.0.1:14550)");
  fly->add_option("--listen", options.listen, "our own port (default: one that is free)");
  auto* pace = fly->add_option("--pace", options.pace, "virtual seconds to one of the host (1)")
                   ->check(CLI::Range(0.001, 1000.0))
                   ->check(finite);
  auto* target = fly->add_option("--target", run.options.target,
                                 "bench/NAME: a physical board, at its bench's own pace")
                     ->excludes(pace);
  fly->add_option("--arm", run.options.arm, "the phrase of the bench's safety")->needs(target);
  fly->add_option("--seconds", options.seconds, "of virtual time (default: until Ctrl-C)")
      ->check(CLI::Range(0.001, 1e6))
      ->check(finite);
  fly->add_option("--image", options.image, "instead of the plan's");
  fly->add_option("--board", options.board, "instead of the plan's");
  fly->add_option("--vehicle", options.vehicle, "instead of the plan's");
  fly->add_option("--stick", options.stick,
                  "a game controller as the transmitter's sticks: a file (test_plans/sticks)");
  fly->add_option("--seed", run.seed, "instead of the plan's own")->check(seed_complaint);
  fly->add_option("--out", run.options.out, "where the run goes (default: results)");
  return fly;
}

CLI::App* add_export(CLI::App& app, ExportOptions& options) {
  auto* command = app.add_subcommand("export", "a run's messages in other formats");
  command->add_option("run", options.run, "a run's folder, or its messages.whirl")->required();
  for (const std::string& format : export_formats()) {
    command->add_flag_callback("--" + format,
                               [&options, format] { options.formats.push_back(format); });
  }
  command->add_option("--out", options.out, "where the files go (default: the run's folder)");
  return command;
}

CLI::App* add_decode(CLI::App& app, DecodeOptions& options) {
  auto* decode = app.add_subcommand("decode", "a logic analyser's capture as rows of bus.csv");
  decode->add_option("capture", options.capture, ".sr, .vcd")->required();
  decode->add_option("--board", options.board, "whose wires its channels name")->required();
  decode->add_option("--rate", options.rate, "at which a .vcd is looked at (50 MHz)");
  return decode;
}

CLI::App* add_parity(CLI::App& app, ParityOptions& options) {
  auto* parity = app.add_subcommand("parity", "two runs of one plan, figure by figure");
  parity
      ->add_option("first", options.first,
                   "a run's folder: of the virtual board, or of native controllers")
      ->required();
  parity->add_option("second", options.second, "another one: of a bench, or of several boards")
      ->required();
  parity->add_option("--page", options.page, "where the page goes (default: the second's folder)");
  return parity;
}

CLI::App* add_sweep(CLI::App& app, SweepOptions& options) {
  auto* sweeps = app.add_subcommand(
      "sweep", "thrust, torque, power and current of a propeller, motor, stand or vehicle file");
  sweeps
      ->add_option("file", options.file,
                   "a propeller, a motor, a stand (a calibration's file) or a vehicle (Lua)")
      ->required();
  sweeps->add_option("--speed", options.speed,
                     "of the sweeps over inflow and advance: \"4500 rpm\"");
  sweeps->add_option("--top-speed", options.top_speed,
                     "end of the static sweep (default 6000 rpm)");
  sweeps
      ->add_option("--speeds", options.speeds,
                   "of a propeller's curves over J: \"3000 rpm,4500 rpm\" (default: those of the "
                   "measured files, or half, three quarters and all of the top)")
      ->delimiter(',');
  sweeps
      ->add_option("--J", options.advance_ratios,
                   "V/(n D) of a propeller's curves over speed (default 0,0.2,0.4)")
      ->delimiter(',');
  sweeps->add_option("--voltage", options.voltage,
                     "of the bus (default: the full pack; a motor alone: 11.1 V): \"16.4 V\"");
  sweeps->add_option(
      "--measured", options.measured,
      "measured points to lay over: of a propeller columns rpm J CT CP, of a motor or "
      "stand V rpm A, and Nm N duty prop");
  auto* seeds = sweeps->add_option("--seeds", options.seeds,
                                   "instead of curves, what its copies of these seeds are: 1..100");
  seeds->check(seeds_complaint);
  for (const char* other :
       {"--speed", "--top-speed", "--speeds", "--J", "--voltage", "--measured"}) {
    seeds->excludes(sweeps->get_option(other));
  }
  sweeps
      ->add_option("--tolerance", options.tolerance,
                   "of the copies: typical or worst (default: the file's, else typical)")
      ->check(CLI::IsMember({"typical", "worst"}))
      ->needs(seeds);
  return sweeps;
}

CLI::App* add_history(CLI::App& app, HistoryOptions& history, RunOptions& options) {
  auto* past = app.add_subcommand("history", "how the expectations of a plan went, run by run");
  past->add_option("plan", history.plan, "plan name (default: all)");
  past->add_option("--expectation", history.expectation, "only names that contain this");
  past->add_option("--last", history.last, "so many runs")->check(CLI::Range(1, 1000));
  past->add_option("--out", options.out, "where the runs went (default: results)");
  return past;
}

struct Calibrates {
  CLI::App *all, *bound;
};

Calibrates add_calibrate(CLI::App& app, CalibrateOptions& options, std::string& seed) {
  auto* calibrates = app.add_subcommand("calibrate", "bench procedures that find constants");
  calibrates->require_subcommand(1);
  auto* esc = calibrates->add_subcommand(
      "esc", "motor, current sense and propeller of an ESC on the thrust stand");
  esc->add_option("file", options.file, "what stands there (test_plans/calibrations/*.lua)")
      ->required();
  esc->add_option("--write", options.write, "the constants as a file that plans include");
  esc->add_option("--data", options.data, "fit this data.txt of an earlier run again");
  esc->add_option("--seed", seed, "of another copy of the hardware, into a folder of its own")
      ->check(seed_complaint);
  auto* bound = calibrates->add_subcommand(
      "bound", "which inflow that ESC can tell from power at all, by its parts' stated errors");
  bound->add_option("file", options.file, "what stands there (test_plans/calibrations/*.lua)")
      ->required();
  return {calibrates, bound};
}

CLI::App* add_fuzz(CLI::App& app, FuzzOptions& options) {
  auto* fuzz =
      app.add_subcommand("fuzz", "random inputs by seed; whatever breaks is a bug of whirl");
  fuzz->add_option("fuzzers", options.names, "registers, images, parsers (default: all)");
  fuzz->add_flag("--smoke", options.smoke, "a few seconds of each");
  fuzz->add_option("--seeds", options.seeds, "so many of each");
  fuzz->add_option("--first", options.first, "the first seed (default 0)");
  return fuzz;
}

int run_calibrate(const Calibrates& calibrates, CalibrateOptions calibration, const RunCommand& run,
                  const Composition& composition) {
  if (*calibrates.bound) return inflow_bound_command(calibration.file, composition);
  calibration.seed = run.options.seed;
  calibration.command = "whirl calibrate esc " + calibration.file +
                        (run.seed.empty() ? "" : " --seed " + run.seed) +
                        (calibration.write.empty() ? "" : " --write " + calibration.write) +
                        (calibration.data.empty() ? "" : " --data " + calibration.data);
  return calibrate_esc_command(calibration, composition);
}

int run_chosen(int argc, char** argv, Composition composition) {
  CLI::App app{"Whirlstand: a test stand for rotorcraft firmware", "whirl"};
  app.footer(kExamples);
  app.set_version_flag("--version", std::string("whirl ") + WHIRL_VERSION);
  app.require_subcommand(1);

  RunCommand run(app);
  RunOptions& options = run.options;

  FlyOptions flying;
  auto* fly = add_fly(app, flying, run);
  run.add_limits(app);

  auto* list = app.add_subcommand("list", "list plans");
  add_plan_options(*list, options);

  HistoryOptions history;
  auto* past = add_history(app, history, options);

  ExportOptions exported;
  auto* exports = add_export(app, exported);

  SweepOptions sweep;
  auto* sweeps = add_sweep(app, sweep);

  TimingOptions timing;
  auto* validate = app.add_subcommand("validate", "the plant against its references");
  validate->add_flag("--timing", timing.wanted,
                     "instead: what instructions cost on the virtual board");
  std::vector<std::string> validated;
  validate->add_option("file", validated,
                       "a propeller, motor or stand and files of its measured points, judged; with "
                       "--timing: lines of "
                       "a timing image on a real board");

  CalibrateOptions calibration;
  const Calibrates calibrates = add_calibrate(app, calibration, run.seed);

  const BenchWords benches(app);
  DecodeOptions decoding;
  auto* decode = add_decode(app, decoding);
  ParityOptions pair;
  auto* parity = add_parity(app, pair);

  FuzzOptions fuzzing;
  auto* fuzz = add_fuzz(app, fuzzing);

  auto* job = app.add_subcommand("job", "one run, for whirl itself")->group("");
  auto* devices = app.add_subcommand("devices", "what a board file's devices may be, key by key");
  auto* doctor = app.add_subcommand("doctor", "check tools and versions");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  if (const auto good = run.parse_texts(); !good) return complain(good.error());
  if (!options.out.empty()) composition.results = options.out;
  if (*fly) return fly_command(flying, options, composition);
  if (*list) return list_command(options, composition);
  if (*past) return history_command(history, composition.results);
  if (*exports) return export_command(exported);
  if (*sweeps) return sweep_command(sweep, composition);
  if (*validate) {
    if (!timing.wanted && !validated.empty()) {
      const std::vector<std::string> points(validated.begin() + 1, validated.end());
      return validate_file_command(validated.front(), points, composition);
    }
    if (validated.size() > 1) {
      return complain(Error{ErrorKind::bad_input, "--timing", "judges one file at a time", ""});
    }
    if (!validated.empty()) timing.file = validated.front();
    return timing.wanted ? timing_command(timing, composition) : validate_command(composition);
  }
  if (*calibrates.all) return run_calibrate(calibrates, calibration, run, composition);
  if (const auto code = benches.run(composition)) return *code;
  if (*decode) return decode_command(decoding, composition);
  if (*parity) return parity_command(pair);
  if (*fuzz) return fuzz_command(fuzzing);
  if (*job) return job_command(composition);
  if (*devices) return devices_command();
  if (*doctor) return doctor_command(composition.root);
  return run_command(options, composition);
}

}  // namespace

int run_program(int argc, char** argv, const Composition& composition) {
  hold_standard_streams();
  int code = 4;
  try {
    std::error_code gone;
    std::ignore = std::filesystem::current_path(gone);
    code = gone ? complain({ErrorKind::bad_input, "", "the current folder is not there any more",
                            "go to one that is"})
                : run_chosen(argc, argv, composition);
  } catch (...) {
    code = complain(error_of_current_exception());
  }
  return code_with_output(code);
}

}  // namespace whirl::cli

#include "harness/cli/bench_words.hpp"

namespace whirl::cli {

BenchWords::BenchWords(CLI::App& app) {
  auto* all = app.add_subcommand("bench", "physical boards on this host's wires");
  all->require_subcommand(1);
  const auto named = [all](const char* word, const char* what, std::string& name) {
    auto* command = all->add_subcommand(word, what);
    command->add_option("name", name, "of test_plans/benches, or a file")->required();
    return command;
  };
  check_ = named("check", "is all there, how fast and steady is each link", checking_.name);
  check_->add_option("--seconds", checking_.seconds, "of each measurement (2)")
      ->check(CLI::Range(0.1, 600.0));
  scope_ = named("scope", "its signals, live in the terminal", looking_.name);
  scope_->add_option("--seconds", looking_.seconds, "(default: until q or Ctrl-C)")
      ->check(CLI::Range(0.1, 1e6));
  scope_->add_option("--column", looking_.column_s, "seconds behind one column (0.1)")
      ->check(CLI::Range(0.01, 10.0));
  flash_ =
      named("flash", "write an image by the debug probe, read it back, start it", probing_.name);
  flash_->add_option("image", probing_.image, "of build/firmware, or a file")->required();
  probe_ = named("probe", "how busy the core is, by the debug probe, while it runs", probing_.name);
  probe_->add_option("image", probing_.image, "that is on the board")->required();
  probe_->add_option("--samples", probing_.samples, "of the program counter (1000)")
      ->check(CLI::Range(1, 10'000'000));
  probe_->add_flag("--halt", probing_.halt, "also halt the core and show the registers of a fault");
  probe_->add_flag("--reset", probing_.reset, "first");
  pace_ = all->add_subcommand("pace", "how steady a kilohertz is here, beside an empty loop");
  pace_->add_option("--seconds", pacing_.seconds, "of each (60)")->check(CLI::Range(1.0, 3600.0));
  pace_->add_option("--late", pacing_.late_us, "what counts as late, in us (200)")
      ->check(CLI::Range(1.0, 1e5));
  pace_->add_option("--overload", pacing_.overload, "threads that take the processor away")
      ->check(CLI::Range(0, 64));
  add_stand_in(app);
}

void BenchWords::add_stand_in(CLI::App& app) {
  stand_in_ = app.add_subcommand(
      "standin", "a virtual board as if it were metal: its lines on this host, in real time");
  stand_in_->add_option("board", standing_.board, "of test_plans/boards, or a file (esc32v2)");
  stand_in_->add_option("--image", standing_.image,
                        "of build/firmware, or an ELF (esc; of a board that flies: flight)");
  stand_in_->add_option("--stand", standing_.stand, "the stand's table, as a plan writes it");
  stand_in_->add_option("--pace", standing_.pace, "of the host's time (1)")
      ->check(CLI::Range(0.001, 10.0));
  stand_in_->add_option("--folder", standing_.folder,
                        "where its lines and its bench file stand (standin)");
  stand_in_->add_option("--serial", standing_.serial, "number of the played bridge");
  stand_in_->add_flag("!--no-bridge", standing_.bridge, "play no USB bridge (no /dev/uhid)");
  stand_in_->add_option("--can", standing_.can,
                        "interface that its CAN, or the pod's, is joined to: vcan0");
  stand_in_->add_flag("--pod", standing_.pod,
                      "a pod beside it plays its sensors and ESCs: px4fmu_v1_sbus");
  stand_in_->add_option("--seconds", standing_.seconds, "end after so long (default: a signal)");
}

std::optional<int> BenchWords::run(const Composition& composition) const {
  if (*check_) return bench_check_command(checking_, composition);
  if (*scope_) return bench_scope_command(looking_, composition);
  if (*flash_) return bench_flash_command(probing_, composition);
  if (*probe_) return bench_probe_command(probing_, composition);
  if (*pace_) return bench_pace_command(pacing_);
  if (*stand_in_) return composition.stand_in(standing_);
  return std::nullopt;
}

}  // namespace whirl::cli

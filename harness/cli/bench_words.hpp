// The words of `whirl bench` and `whirl standin`, and what each does.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>

#include "harness/cli/bench_command.hpp"
#include "harness/cli/composition.hpp"
#include "harness/cli/pace_command.hpp"
#include "harness/cli/probe_command.hpp"
#include "harness/cli/scope_command.hpp"

namespace whirl::cli {

class BenchWords {
 public:
  explicit BenchWords(CLI::App& app);
  BenchWords(const BenchWords&) = delete;  // the parser writes into it
  BenchWords& operator=(const BenchWords&) = delete;

  // After parsing. Nothing: it was another command.
  std::optional<int> run(const Composition& composition) const;

 private:
  void add_stand_in(CLI::App& app);

  BenchOptions checking_;
  ScopeOptions looking_;
  ProbeOptions probing_;
  PaceOptions pacing_;
  StandInRequest standing_;
  CLI::App *check_ = nullptr, *scope_ = nullptr, *flash_ = nullptr, *probe_ = nullptr,
           *pace_ = nullptr, *stand_in_ = nullptr;
};

}  // namespace whirl::cli

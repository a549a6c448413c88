// The words of `whirl run` and `whirl limits`, and what other commands share of them.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/cli/options.hpp"

namespace whirl::cli {

void add_plan_options(CLI::App& command, RunOptions& options);
std::string seed_complaint(const std::string& text);  // "": it is one
std::string seeds_complaint(const std::string& text);

class RunCommand {
 public:
  explicit RunCommand(CLI::App& app);
  RunCommand(const RunCommand&) = delete;  // the parser writes into it
  RunCommand& operator=(const RunCommand&) = delete;

  // A run on several seeds, for the limits that follow from it.
  void add_limits(CLI::App& app);

  // What was parsed as text. Nothing is said twice.
  Result<Done> parse_texts();

  RunOptions options;
  std::string seed;

 private:
  Result<Done> read_settings();

  std::string seeds_, margin_, copper_rate_;
  std::vector<std::string> settings_;
  CLI::App* limits_ = nullptr;
};

}  // namespace whirl::cli

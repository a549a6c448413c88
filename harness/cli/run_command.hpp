// whirl run: finds the plans, runs them (several at once with --jobs), tells and files the outcome.
#pragma once
#include "harness/cli/composition.hpp"
#include "harness/cli/options.hpp"

namespace whirl::cli {

int run_command(const RunOptions& options, const Composition& composition);
int list_command(const RunOptions& options, const Composition& composition);

}  // namespace whirl::cli

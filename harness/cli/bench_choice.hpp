// Which bench a run is for, and whether the plan can be run there.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/board/node.hpp"
#include "harness/cli/options.hpp"
#include "harness/plan/plan_file.hpp"
#include "harness/target/bench/bench_description.hpp"

namespace whirl::cli {

// Before any plan is run, for plans in processes of their own know of no target. Errors  bad_input: no target of
// that kind; --gdb, --twice, several seeds or several runs at once
Result<Done> check_bench_options(const RunOptions& options);

// Of test_plans/benches, or a path. `command`: who asks, for the message. A line to a telemetry radio of its board is one
// that carries MAVLink.
// Errors  bad_input: no such bench, no such board, a line of kind "mavlink" where the board has no radio
Result<bench::BenchDescription> bench_named(const std::string& name, const char* command,
                                            const std::string& root);

// Errors  bad_input: a capture beside what is not the one run that it is of
Result<Done> check_copper_options(const RunOptions& options);

// How late its host may be is what the plan says, where it says it.
// Errors  bad_input: no such bench, another board than the plan's, a bus that the plan uses and nothing joins,
//         MAVLink where the board has no radio, the phrase was not said; several boards, a vehicle; what check_bench_options() refuses
Result<bench::BenchDescription> bench_for(const plan::Plan& plan, const std::vector<Node>& nodes,
                                          const RunOptions& options, const std::string& root);

}  // namespace whirl::cli

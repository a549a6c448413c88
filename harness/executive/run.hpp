// One run of one plan: target and world in lockstep, the plan's script between them, a report at the
// end.
//
//   Step     at t_k the script acts; then the target runs (t_k, t_k+1] while the world takes the same
//            step with what the target had done until t_k, and what had happened is filed
//   Digest   over every batch, both ways, in order; host times enter nowhere but Report::host
//   Beside   a companion (companion.hpp) may pace the run and command it; then the script's end is not the
//            run's, and nothing is judged
//   Ends     the script returns; a fault of the core; the plan's timeout in virtual time; an error
#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "harness/board/node.hpp"
#include "harness/executive/companion.hpp"
#include "harness/plan/plan_file.hpp"
#include "harness/target/target.hpp"
#include "harness/world/world.hpp"
#include "results/messages/message_file.hpp"
#include "results/report.hpp"

namespace whirl {

struct RunParts {
  plan::PlanFile& file;
  const plan::Plan& plan;
  const std::vector<Node>& nodes;  // the world surrounds the first
  World& world;
  Target& target;
  std::uint64_t seed = 1;
  results::MessageWriter* messages = nullptr;  // what crosses is written there; null: nowhere
  std::string folder = {};         // where the boards' parts leave their files; empty: nowhere
  Companion* companion = nullptr;  // null: nobody
};

struct RunRecord {
  results::Report report;
  // What the boards' processes were told, by the names of their nodes.
  std::vector<std::pair<std::string, std::string>> board_texts = {};
  std::optional<results::MessageWriter> messages = std::nullopt;  // where they were written
};

struct Progress {
  double t_s = 0;  // virtual
  const std::string& step;
  const World& world;
};
// What the file of messages says of a run before it begins.
results::RunHead run_head(const plan::Plan& plan, const std::vector<Node>& nodes,
                          const World& world, std::uint64_t seed);
std::vector<results::Column> columns_of(const World& world);

using ProgressSink = std::function<void(const Progress&)>;  // every 10 ms of virtual time

RunRecord execute(const RunParts& parts, const ProgressSink& progress = nullptr);

}  // namespace whirl

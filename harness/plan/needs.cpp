#include "harness/plan/needs.hpp"

namespace whirl::plan {

std::vector<Offer> needs_of_call(const std::string& call) {
  if (call == "budget") return {Offer::watches};
  if (call == "bus" || call == "can") return {Offer::bus_log};
  if (call == "latency") return {Offer::watches, Offer::bus_log};
  return {};
}

std::vector<Need> needs_of(const Plan& plan) {
  std::vector<Need> needs;
  if (plan.nodes.size() > 1) needs.push_back({Offer::virtual_time, "nodes", plan.place});
  for (const PlanNode& node : plan.nodes) {
    if (!node.watch.empty()) needs.push_back({Offer::watches, "watch", plan.place});
  }
  for (const SourceCall& call : plan.calls) {
    for (const Offer offer : needs_of_call(call.name)) {
      needs.push_back({offer, "t:" + call.name, plan.file + ":" + std::to_string(call.line)});
    }
  }
  return needs;
}

std::string not_offered(const std::string& what, Offer offer) {
  return what + " asks for " + name(offer) + ", which this target does not offer";
}

Result<Done> check_offers(const Plan& plan, const Offers& offers) {
  for (const Need& need : needs_of(plan)) {
    if (offers.has(need.offer)) continue;
    return Error{ErrorKind::bad_input, need.place, not_offered(need.what, need.offer), ""};
  }
  return Done{};
}

Result<Done> check_faults(const Plan& plan, const std::function<bool(const std::string&)>& acts) {
  for (const SourceCall& word : plan.words) {
    if (acts(word.name)) continue;
    return Error{ErrorKind::bad_input, plan.file + ":" + std::to_string(word.line),
                 not_offered("a fault of kind " + word.name, Offer::wire_faults), ""};
  }
  return Done{};
}

Result<Done> check_signals(const Plan& plan, const std::vector<Signal>& here,
                           const std::vector<Signal>& elsewhere) {
  const SignalTable own(here), other(elsewhere);
  const auto knows = [](const SignalTable& table, const std::string& word) {
    return table.find(word) || table.find_with_unit(word);
  };
  for (const SourceCall& word : plan.words) {
    if (knows(own, word.name) || !knows(other, word.name)) continue;
    return Error{ErrorKind::bad_input, plan.file + ":" + std::to_string(word.line),
                 "there is no signal '" + word.name + "' here", "there are " + own.names()};
  }
  return Done{};
}

}  // namespace whirl::plan

#include "results/messages/run_head.hpp"

#include <nlohmann/json.hpp>

#include "base/json_text.hpp"

namespace whirl::results {
namespace {

using nlohmann::json;

constexpr std::size_t kMost_columns = 10'000, kMost_nodes = 256;

RunHead head_of(const json& from) {
  RunHead head;
  from.at("plan").get_to(head.plan);
  from.at("seed").get_to(head.seed);
  from.at("step_ns").get_to(head.step_ns);
  for (const json& column : from.at("columns")) {
    head.columns.push_back({column.at("name"), column.at("unit_suffix"), column.at("unit")});
  }
  for (const json& node : from.at("nodes")) {
    NodeHead& named = head.nodes.emplace_back();
    named = {node.at("name"), node.at("devices"), node.at("pins"), node.at("watch")};
    if (node.contains("buses")) node.at("buses").get_to(named.buses);
    if (node.contains("throttles")) node.at("throttles").get_to(named.throttles);
    if (!node.contains("bauds_Hz")) continue;
    for (const json& one : node.at("bauds_Hz")) {
      named.bauds_Hz[one.at(0).get<int>()] = one.at(1).get<double>();
    }
  }
  return head;
}

Error no_head(const std::string& why) {
  return {ErrorKind::bad_input, "", "is no file of a run's messages: " + why, ""};
}

}  // namespace

std::string head_text(const RunHead& head) {
  json out = {{"plan", head.plan}, {"seed", head.seed}, {"step_ns", head.step_ns}};
  out["columns"] = out["nodes"] = json::array();
  for (const Column& c : head.columns) {
    out["columns"].push_back({{"name", c.name}, {"unit_suffix", c.unit_suffix}, {"unit", c.unit}});
  }
  for (const NodeHead& n : head.nodes) {
    json bauds = json::array();
    for (const auto& [uart, baud_Hz] : n.bauds_Hz) bauds.push_back({uart, baud_Hz});
    out["nodes"].push_back({{"name", n.name},
                            {"devices", n.devices},
                            {"pins", n.pins},
                            {"watch", n.watch},
                            {"buses", n.buses},
                            {"bauds_Hz", bauds},
                            {"throttles", n.throttles}});
  }
  return text_of(out, -1, NoUtf8::replace);
}

Result<RunHead> read_head(std::string_view text) {
  const json from = parse_json(text);
  try {
    RunHead head = head_of(from);
    if (head.step_ns <= 0) return no_head("a step of no time");
    if (head.columns.size() > kMost_columns) return no_head("too many signals");
    if (head.nodes.size() > kMost_nodes) return no_head("too many boards");
    return head;
  } catch (const json::exception&) {
    return no_head("its first lines do not say of which run");
  }
}

}  // namespace whirl::results

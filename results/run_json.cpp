// run.json: everything about a run that a program may want to know.
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_text.hpp"
#include "results/folder.hpp"
#include "results/legal_json.hpp"

namespace whirl::results {
namespace {

using nlohmann::ordered_json;

// JSON has no NaN: what could not be measured is null.
ordered_json number(double x) {
  return std::isfinite(x) ? ordered_json(x) : ordered_json(nullptr);
}

ordered_json limit_of(const Expectation& e) {
  if (e.low && e.high && *e.low != *e.high) return {number(*e.low), number(*e.high)};
  if (e.high) return number(*e.high);
  if (e.low) return number(*e.low);
  return nullptr;
}

ordered_json expectation(const Expectation& e) {
  return {{"name", e.name},
          {"verdict", name(e.verdict)},
          {"measured", number(e.measured)},
          {"how", e.how},
          {"limit", limit_of(e)},
          {"unit", e.unit},
          {"margin", number(e.margin)},
          {"marginal", e.marginal},
          {"place", e.place},
          {"t_s", e.t_s},
          {"note", e.note},
          {"signals", e.signals},
          {"from_s", e.from_s},
          {"to_s", e.to_s},
          {"level", e.level},
          {"limits_SI", e.limits_SI}};
}

ordered_json task(const TaskRow& row) {
  return {{"name", row.name},
          {"calls", row.calls},
          {"period_mean_s", number(row.period_mean_s)},
          {"period_max_s", number(row.period_max_s)},
          {"execution_min_s", number(row.execution_min_s)},
          {"execution_p50_s", number(row.execution_p50_s)},
          {"execution_p99_s", number(row.execution_p99_s)},
          {"execution_max_s", number(row.execution_max_s)},
          {"response_p99_s", number(row.response_p99_s)},
          {"response_max_s", number(row.response_max_s)},
          {"latency_max_s", number(row.latency_max_s)},
          {"execution_min_cycles", number(row.execution_min_cycles)},
          {"execution_p50_cycles", number(row.execution_p50_cycles)},
          {"execution_p99_cycles", number(row.execution_p99_cycles)},
          {"execution_max_cycles", number(row.execution_max_cycles)},
          {"response_max_cycles", number(row.response_max_cycles)}};
}

ordered_json interrupt(const InterruptRow& row) {
  return {{"exception", row.exception},
          {"handler", row.handler},
          {"requests", row.requests},
          {"latency_mean_s", number(row.latency_mean_s)},
          {"latency_max_s", number(row.latency_max_s)},
          {"latency_max_at_s", number(row.latency_max_at_s)}};
}

ordered_json host_times(const HostTimes& host) {
  return {{"total_s", host.total_s},
          {"start_s", host.start_s},
          {"target_wait_s", host.target_wait_s},
          {"world_s", host.world_s},
          {"script_s", host.script_s},
          {"logging_s", host.logging_s},
          {"results_s", host.results_s}};
}

ordered_json notes(const std::vector<Note>& all) {
  ordered_json out = ordered_json::array();
  for (const Note& n : all) out.push_back({{"t_s", n.t_s}, {"who", n.who}, {"text", n.text}});
  return out;
}

ordered_json flight_log(const FlightLogRow& row) {
  return {{"file", row.file},     {"card", row.card},       {"name", row.name},
          {"bytes", row.bytes},   {"samples", row.samples}, {"dropouts", row.dropouts},
          {"closed", row.closed}, {"from_s", row.from_s},   {"to_s", row.to_s},
          {"damage", row.damage}};
}

}  // namespace

std::string run_json(const Report& r) {
  ordered_json out;
  out["plan"] = r.plan;
  out["file"] = r.file;
  out["tags"] = r.tags;
  out["verdict"] = name(r.verdict);
  out["blame"] = name(r.blame);  // of all but pass and none
  out["reason"] = r.reason;
  out["reasons"] = ordered_json::array();
  for (const Reason& why : r.reasons) {
    out["reasons"].push_back({{"blame", name(why.blame)}, {"what", why.what}});
  }
  out["exit_code"] = exit_code(r);
  out["seed"] = r.seed;
  out["digest"] = r.digest;
  out["virtual_s"] = r.virtual_s;
  out["host_s"] = r.host.total_s;
  out["speed_factor"] = r.speed_factor();
  out["host"] = host_times(r.host);
  out["timing_profile"] = r.timing_profile;
  out["versions"] = ordered_json::object();
  for (const auto& [what, version] : r.versions) out["versions"][legal_text(what)] = version;
  out["parts"] = ordered_json::array();
  for (const PartRow& part : r.parts) {
    out["parts"].push_back(
        {{"name", part.name}, {"value", number(part.value)}, {"unit", part.unit}});
  }
  out["doubts"] = r.doubts;
  out["expectations"] = ordered_json::array();
  for (const Expectation& e : r.expectations) out["expectations"].push_back(expectation(e));
  out["tasks"] = ordered_json::array();
  for (const TaskRow& row : r.tasks) out["tasks"].push_back(task(row));
  out["interrupts"] = ordered_json::array();
  for (const InterruptRow& row : r.interrupts) out["interrupts"].push_back(interrupt(row));
  out["faults"] = ordered_json::array();
  for (const FaultRow& f : r.faults) {
    out["faults"].push_back(
        {{"kind", f.kind},
         {"target", f.target},
         {"start_s", f.start_s},
         {"end_s", number(f.end_s)},
         {"applied_s", f.applied_s < 0 ? ordered_json(nullptr) : ordered_json(f.applied_s)}});
  }
  out["cpu_faults"] = ordered_json::array();
  for (const CpuFaultRow& f : r.cpu_faults) {
    out["cpu_faults"].push_back({{"name", f.name},
                                 {"where", f.where},
                                 {"t_s", f.t_s},
                                 {"registers", f.registers},
                                 {"backtrace", f.backtrace}});
  }
  out["findings"] = notes(r.findings);
  out["log"] = notes(r.log);
  out["steps"] = notes(r.steps);
  out["flight_logs"] = ordered_json::array();
  for (const FlightLogRow& row : r.flight_logs) out["flight_logs"].push_back(flight_log(row));
  out["histograms"] = ordered_json::array();
  for (const Histogram& h : r.histograms) {
    out["histograms"].push_back(
        {{"name", h.name}, {"unit", h.unit}, {"limit", h.limit}, {"samples", h.samples}});
  }
  const auto board = parse_ordered_json(r.statistics_json);
  out["board"] = board.is_discarded() ? ordered_json(nullptr) : board;
  for (const auto& [node, said] : r.boards) {
    const auto words = parse_ordered_json(said);
    out["boards"][legal_text(node)] = words.is_discarded() ? ordered_json(nullptr) : words;
  }
  make_legal(out);
  return text_of(out, 2) + "\n";
}

}  // namespace whirl::results

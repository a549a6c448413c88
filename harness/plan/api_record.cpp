// t:record and what a record can be asked. The metrics themselves are in harness/metrics.
#include <algorithm>
#include <cmath>

#include "harness/metrics/response.hpp"
#include "harness/plan/raise.hpp"
#include "harness/plan/values.hpp"

namespace whirl::plan {
namespace {

constexpr const char* kRecord = "record";
constexpr double kRows_per_instruction = 4.0;  // what a metric's walk over its rows costs a plan

metrics::Record view(const Stage& stage, const RecordInfo& info, std::size_t column) {
  return stage.rows.record(info.number, column);
}

// The record that a method is called on. Each call walks over its rows, and pays for it.
const RecordInfo& record_of(lua_State* L) {
  Script& self = Script::of(L);
  const RecordInfo& info = self.records[check_handle(L, 1, kRecord)];
  const std::int64_t rows = (info.to_ns - info.from_ns) / self.stage().rows.step_ns();
  lua::Sandbox::spend(L, static_cast<double>(rows) / kRows_per_instruction);
  return info;
}

// The column a call speaks of: the only one, or the one named first; then come its own arguments.
struct Chosen {
  const RecordInfo* info;
  std::size_t column;
  int next;  // index of the next argument
  std::string name;
};

Chosen choose(lua_State* L) {
  Script& self = Script::of(L);
  const RecordInfo& info = record_of(L);
  const auto& columns = self.stage().rows.columns();
  if (info.columns.size() == 1) return {&info, info.columns[0], 2, columns[info.columns[0]].name};
  const std::string wanted = check_text(L, 2, "a record of several signals: the signal's name");
  for (std::size_t column : info.columns) {
    if (columns[column].name == wanted) return {&info, column, 3, wanted};
  }
  raise(L, "signal '" + wanted + "' is not in this record");
}

int push(lua_State* L, const Chosen& c, double value, Dimension dimension, const char* what,
         bool level = false) {
  push_measurement(
      L, {value, dimension, c.name + what, {c.name}, c.info->from_ns, c.info->to_ns, level});
  return 1;
}

using Metric = double (*)(const metrics::Record&);

template <Metric metric>
int time_metric(lua_State* L, const char* what) {
  const Chosen c = choose(L);
  return push(L, c, metric(view(Script::of(L).stage(), *c.info, c.column)), Dimension::time, what);
}
template <Metric metric>
int value_metric(lua_State* L, const char* what) {
  const Chosen c = choose(L);
  Script& self = Script::of(L);
  return push(L, c, metric(view(self.stage(), *c.info, c.column)), self.dimension(c.column), what,
              true);
}

int rise_time(lua_State* L) {
  return time_metric<metrics::rise_time_s>(L, " rise time");
}
int fall_time(lua_State* L) {
  return time_metric<metrics::fall_time_s>(L, " fall time");
}
// From the last bit of the command on the wire, where the world knows when that was.
int response_time(lua_State* L) {
  const Chosen c = choose(L);
  const double from_call_s =
      metrics::response_time_s(view(Script::of(L).stage(), *c.info, c.column));
  const double wire_s = static_cast<double>(c.info->wire_ns - c.info->from_ns) * 1e-9;
  return push(L, c, from_call_s - wire_s, Dimension::time, " response time");
}
int overshoot(lua_State* L) {
  const Chosen c = choose(L);
  return push(L, c, metrics::overshoot_ratio(view(Script::of(L).stage(), *c.info, c.column)),
              Dimension::ratio, " overshoot");
}
int mean(lua_State* L) {
  return value_metric<metrics::mean>(L, " mean");
}
int final(lua_State* L) {
  return value_metric<metrics::final_mean>(L, " final mean");
}
int maximum(lua_State* L) {
  return value_metric<metrics::maximum>(L, " max");
}
int minimum(lua_State* L) {
  return value_metric<metrics::minimum>(L, " min");
}

int quantile(lua_State* L, double p, const char* what) {
  const Chosen c = choose(L);
  Script& self = Script::of(L);
  const auto record = view(self.stage(), *c.info, c.column);
  return push(L, c, metrics::quantile(record.values.subspan(record.command), p),
              self.dimension(c.column), what);
}
int p50(lua_State* L) {
  return quantile(L, 0.5, " p50");
}
int p99(lua_State* L) {
  return quantile(L, 0.99, " p99");
}

// The distance from a reference at each sample: of one signal, or the norm over those named in a
// table { north = "0 m", east = "0 m" }.
struct Errors {
  std::vector<double> values;  // from the reference rows on
  std::size_t command = 0;
  std::int64_t step_ns = 0;
  Dimension dimension = Dimension::none;
  std::vector<std::string> signals;

  metrics::Record record() const { return {values, step_ns, command}; }
};

void add_squares(Errors& errors, const metrics::Record& record, double reference) {
  errors.values.resize(record.values.size(), 0.0);
  errors.command = record.command;
  errors.step_ns = record.step_ns;
  for (std::size_t i = 0; i < record.values.size(); ++i) {
    const double e = record.values[i] - reference;
    errors.values[i] += e * e;
  }
}

Errors errors_about(lua_State* L, int index) {
  Script& self = Script::of(L);
  const RecordInfo& info = record_of(L);
  Errors errors;
  if (lua_istable(L, index)) {
    const lua::Table given = check_table(L, index);
    for (const std::string& key : given.keys()) {
      const std::size_t column = self.column(L, key);
      if (std::find(info.columns.begin(), info.columns.end(), column) == info.columns.end()) {
        raise(L, "signal '" + key + "' is not in this record");
      }
      if (!errors.signals.empty() && errors.dimension != self.dimension(column)) {
        raise(L, "signals of different dimensions have no common distance");
      }
      errors.dimension = self.dimension(column);
      errors.signals.push_back(key);
      add_squares(errors, view(self.stage(), info, column), given.quantity(key, errors.dimension));
    }
    check_finish(L, given);
    if (errors.signals.empty()) raise(L, "a reference { signal = \"0 m\" } is wanted");
  } else {
    const Chosen c = choose(L);
    errors.dimension = self.dimension(c.column);
    errors.signals = {c.name};
    add_squares(errors, view(self.stage(), info, c.column),
                check_limit(L, index, errors.dimension).value_SI);
  }
  for (double& value : errors.values) value = std::sqrt(value);
  return errors;
}

int reference_index(lua_State* L) {
  return lua_istable(L, 2) ? 2 : choose(L).next;
}

int push_errors(lua_State* L, const Errors& e, double value, Dimension dimension,
                const char* what) {
  const RecordInfo& info = record_of(L);
  std::string name;
  for (const std::string& signal : e.signals) name += (name.empty() ? "" : ", ") + signal;
  push_measurement(L, {value, dimension, name + what, e.signals, info.from_ns, info.to_ns, false});
  return 1;
}

int rms_error(lua_State* L) {
  const Errors e = errors_about(L, reference_index(L));
  return push_errors(L, e, metrics::rms_about(e.record(), 0.0), e.dimension, " RMS error");
}
int max_error(lua_State* L) {
  const Errors e = errors_about(L, reference_index(L));
  return push_errors(L, e, metrics::maximum(e.record()), e.dimension, " max error");
}

// RMS about zero.
int rms(lua_State* L) {
  const Chosen c = choose(L);
  Script& self = Script::of(L);
  return push(L, c, metrics::rms_about(view(self.stage(), *c.info, c.column), 0.0),
              self.dimension(c.column), " RMS");
}

// record:settled("10 cm", "1.1 m"), record:settled("10 cm", { north = "0 m" }), or
// record:settled("5 %"): about the final mean, in percent of the change.
int settled(lua_State* L) {
  Script& self = Script::of(L);
  const RecordInfo& info = record_of(L);
  const int band = info.columns.size() == 1 || lua_istable(L, 3) ? 2 : 3;
  if (!lua_isnoneornil(L, band + 1)) {
    const Errors e = errors_about(L, band + 1);
    const double width = check_limit(L, band, e.dimension).value_SI;
    return push_errors(L, e, metrics::settled_s(e.record(), 0.0, width), Dimension::time,
                       " settling time");
  }
  const Chosen c = choose(L);
  const metrics::Record record = view(self.stage(), info, c.column);
  const double share = check_limit(L, band, Dimension::ratio).value_SI;
  const double width = share * std::abs(metrics::change(record));
  return push(L, c, metrics::settled_s(record, metrics::final_mean(record), width), Dimension::time,
              " settling time");
}

std::vector<std::size_t> columns_of(lua_State* L, int index) {
  Script& self = Script::of(L);
  std::vector<std::size_t> columns;
  if (!lua_istable(L, index)) return {self.column(L, check_text(L, index, "a signal's name"))};
  const auto n = static_cast<int>(lua_rawlen(L, index));
  for (int i = 1; i <= n; ++i) {
    lua_rawgeti(L, index, i);
    columns.push_back(self.column(L, check_text(L, -1, "a signal's name")));
    lua_pop(L, 1);
  }
  if (columns.empty()) raise(L, "a record of no signals");
  return columns;
}

int recorded(lua_State* L, int, lua_KContext number) {
  Script& self = Script::of(L);
  self.look();
  RecordInfo& info = self.records[static_cast<std::size_t>(number)];
  info.to_ns = self.stage().now_ns;
  self.stage().rows.close_record(info.number);
  const std::int64_t wire_ns = self.stage().world.command_on_wire_ns();
  info.wire_ns = wire_ns <= info.to_ns ? std::max(wire_ns, info.from_ns) : info.from_ns;
  push_handle(L, kRecord, static_cast<std::size_t>(number));
  return 1;
}

// t:record(signals, duration [, function]): calls the function, waits, gives the record.
int record(lua_State* L) {
  Script& self = Script::of(L);
  RecordInfo info;
  info.columns = columns_of(L, 2);
  const std::int64_t duration_ns = check_duration_ns(L, 3);
  info.from_ns = self.stage().now_ns;
  if (!lua_isnoneornil(L, 4)) {
    lua_pushvalue(L, 4);
    lua_call(L, 0, 0);  // a t:wait in there is refused by Lua: the record begins at the command
  }
  info.number = self.stage().rows.open_record(info.columns);
  const std::size_t number = self.records.size();
  self.records.push_back(std::move(info));
  self.wait_until(self.stage().now_ns + duration_ns);
  return lua_yieldk(L, 0, static_cast<lua_KContext>(number), recorded);
}

}  // namespace

void add_record_calls(lua_State* L) {
  const luaL_Reg calls[] = {{"record", record}, {nullptr, nullptr}};
  luaL_setfuncs(L, calls, 0);
  const luaL_Reg methods[] = {{"rise_time", rise_time},
                              {"fall_time", fall_time},
                              {"response_time", response_time},
                              {"overshoot", overshoot},
                              {"settled", settled},
                              {"mean", mean},
                              {"final", final},
                              {"max", maximum},
                              {"min", minimum},
                              {"rms", rms},
                              {"rms_error", rms_error},
                              {"max_error", max_error},
                              {"p50", p50},
                              {"p99", p99},
                              {nullptr, nullptr}};
  declare_handle(L, kRecord, methods);
}

}  // namespace whirl::plan

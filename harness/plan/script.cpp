#include "harness/plan/script.hpp"

#include <algorithm>
#include <cmath>
#include <lua.hpp>

#include "harness/plan/raise.hpp"
#include "harness/plan/values.hpp"

namespace whirl::plan {
namespace {

constexpr const char* kOwnerKey = "whirl.script";

// s in function(s): the signals at this step, by column name with unit ("height_m").
int read_signal(lua_State* L) {
  Stage& stage = Script::of(L).stage();
  const std::string wanted = check_text(L, 2, "a signal's name");
  const auto& columns = stage.truth.columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto& c = columns[i];
    const std::string full = c.unit_suffix.empty() ? c.name : c.name + "_" + c.unit_suffix;
    if (full == wanted) {
      lua_pushnumber(L, stage.truth.last(i));
      return 1;
    }
    if (c.name == wanted) {
      return raise(L, "signal '" + wanted + "' is written with its unit here", "write s." + full);
    }
  }
  return raise(L, "unknown signal '" + wanted + "'");
}

void push_signals(lua_State* L) {
  lua_newtable(L);
  if (luaL_newmetatable(L, "signals") != 0) {
    lua_pushcfunction(L, read_signal);
    lua_setfield(L, -2, "__index");
  }
  lua_setmetatable(L, -2);
}

void push_t(lua_State* L) {
  declare_measurement(L);
  luaL_newmetatable(L, "t");
  lua_newtable(L);
  add_time_calls(L);
  add_record_calls(L);
  add_expect_calls(L);
  add_timing_calls(L);
  add_action_calls(L);
  add_text_calls(L);
  lua_setfield(L, -2, "__index");
  lua_pop(L, 1);
  push_handle(L, "t", 0);
}

bool meets(double x, const std::optional<Limit>& low, const std::optional<Limit>& high) {
  // Written so that a NaN meets nothing.
  return !std::isnan(x) && (!low || x >= low->value_SI) && (!high || x <= high->value_SI);
}

double margin_of(double x, const std::optional<Limit>& low, const std::optional<Limit>& high) {
  double margin = std::numeric_limits<double>::infinity();
  if (low) margin = std::min(margin, x - low->value_SI);
  if (high) margin = std::min(margin, high->value_SI - x);
  return std::isnan(x) ? x : margin;
}

const char* words(How how) {
  switch (how) {
    case How::at_most:
      return "at most";
    case How::at_least:
      return "at least";
    case How::within:
      return "within";
    case How::equal:
      return "equal to";
  }
  return "?";
}

double seconds(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-9;
}

}  // namespace

Script& Script::of(lua_State* L) {
  lua_getfield(L, LUA_REGISTRYINDEX, kOwnerKey);
  auto* script = static_cast<Script*>(lua_touserdata(L, -1));
  lua_pop(L, 1);
  return *script;
}

Script::Script(PlanFile& file, const Plan& plan, Stage& stage) : file_(file), stage_(stage) {
  lua_State* L = file_.sandbox().state();
  lua_pushlightuserdata(L, this);
  lua_setfield(L, LUA_REGISTRYINDEX, kOwnerKey);
  thread_ = lua_newthread(L);
  luaL_ref(L, LUA_REGISTRYINDEX);  // keeps the thread alive as long as the state
  lua_rawgeti(thread_, LUA_REGISTRYINDEX, plan.run_ref);
  push_t(thread_);
}

std::size_t Script::column(lua_State* L, const std::string& signal) {
  const auto& columns = stage_.truth.columns();
  std::string known;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == signal) return i;
    known += (i == 0 ? "" : ", ") + columns[i].name;
  }
  raise(L, "unknown signal '" + signal + "'", "known: " + known);
  return 0;
}

Dimension Script::dimension(std::size_t column) const {
  return stage_.world.signals()[column].dimension;
}

bool Script::condition(lua_State* L, int ref) {
  lua_rawgeti(L, LUA_REGISTRYINDEX, ref);
  push_signals(L);
  lua_call(L, 1, 1);
  const bool met = lua_toboolean(L, -1) != 0;
  lua_pop(L, 1);
  return met;
}

void Script::wait_until(std::int64_t t_ns, int condition_ref) {
  wake_ns_ = t_ns;
  wake_condition_ = condition_ref;
  condition_met_ = false;
}

Result<Script::State> Script::advance() {
  lua_State* L = file_.sandbox().state();
  // Conditions run outside the coroutine, under one protected call per step.
  file_.sandbox().refill();
  lua_pushcfunction(L, [](lua_State* l) {
    Script& self = of(l);
    const std::int64_t now = self.stage_.now_ns;
    if (self.wake_condition_ != -1 && !self.condition_met_) {
      self.condition_met_ = self.condition(l, self.wake_condition_);
    }
    for (Guard& guard : self.guards) {
      if (guard.condition_ref == -1 || now < guard.from_ns || now >= guard.to_ns) continue;
      if (self.condition(l, guard.condition_ref)) continue;
      if (guard.first_ns < 0) guard.first_ns = now;
      guard.violated_ns += self.stage_.truth.step_ns();
    }
    return 0;
  });
  if (lua_pcall(L, 0, 0, 0) != LUA_OK) {
    Error error = lua::Sandbox::to_error(luaL_tolstring(L, -1, nullptr));
    return error;
  }
  if (stage_.now_ns < wake_ns_ && !condition_met_) return State::waiting;
  wake_condition_ = -1;
  file_.sandbox().refill(thread_);
  int results = 0;
  const int status = lua_resume(thread_, L, started_ ? 0 : 1, &results);
  started_ = true;
  if (status == LUA_YIELD) {
    lua_pop(thread_, results);
    return State::waiting;
  }
  if (status == LUA_OK) return State::done;
  return lua::Sandbox::to_error(luaL_tolstring(thread_, -1, nullptr));
}

void Script::add(results::Expectation e) {
  const auto taken = [&](const std::string& name) {
    return std::any_of(stage_.report.expectations.begin(), stage_.report.expectations.end(),
                       [&](const auto& other) { return other.name == name; });
  };
  const std::string base = e.name;
  for (int n = 2; taken(e.name); ++n) e.name = base + " (" + std::to_string(n) + ")";
  stage_.report.expectations.push_back(std::move(e));
}

void Script::judge(const Measurement& m, How how, std::optional<Limit> low,
                   std::optional<Limit> high, const std::string& place, double t_s,
                   const std::string& note) {
  results::Expectation e;
  e.name = m.name;
  e.how = words(how);
  e.unit = high ? high->unit : low->unit;
  e.verdict = meets(m.value_SI, low, high) ? results::Verdict::pass : results::Verdict::fail;
  e.measured = in_unit(m.value_SI, e.unit);
  if (low) e.low = in_unit(low->value_SI, e.unit);
  if (high) e.high = in_unit(high->value_SI, e.unit);
  // A margin is a difference: an offset of the unit (degC) must not enter twice.
  e.margin = in_unit(margin_of(m.value_SI, low, high), e.unit) - in_unit(0.0, e.unit);
  e.place = place;
  e.t_s = t_s;
  e.signals = m.signals;
  e.from_s = seconds(m.from_ns);
  e.to_s = seconds(m.to_ns);
  e.level = m.level;
  if (low) e.limits_SI.push_back(low->value_SI);
  if (high && how != How::equal) e.limits_SI.push_back(high->value_SI);
  e.note = std::isnan(m.value_SI) && note.empty() ? "nothing to measure" : note;
  add(std::move(e));
}

void Script::set_step(const std::string& name) {
  step_name_ = name;
  stage_.report.steps.push_back({seconds(stage_.now_ns), "plan", name});
}

void Script::add_window(std::int64_t to_ns, Window window) {
  windows_.push_back({stage_.now_ns, to_ns, std::move(window)});
}

void Script::judge_guard(const Guard& guard) {
  const std::int64_t end = std::min(guard.to_ns, stage_.now_ns);
  if (guard.condition_ref != -1) {
    const std::string note =
        guard.first_ns < 0 ? ""
                           : "first violated at " + std::to_string(seconds(guard.first_ns)) + " s";
    judge({seconds(guard.violated_ns), Dimension::time, guard.name + " (time violated)"},
          How::at_most, std::nullopt, Limit{0.0, "s"}, guard.place,
          seconds(std::max<std::int64_t>(guard.first_ns, 0)), note);
    return;
  }
  const auto& truth = stage_.truth;
  double worst = std::numeric_limits<double>::quiet_NaN();
  double worst_margin = std::numeric_limits<double>::infinity();
  std::size_t at = truth.row_at(guard.from_ns);
  for (std::size_t row = at; row < truth.rows() && row <= truth.row_at(end); ++row) {
    const double x = truth.values(*guard.column)[row];
    const double margin = margin_of(x, guard.low, guard.high);
    if (margin >= worst_margin) continue;  // a NaN is taken, and ends the search
    worst = x;
    worst_margin = margin;
    at = row;
    if (std::isnan(x)) break;
  }
  const std::string signal = truth.columns()[*guard.column].name;
  judge({worst, dimension(*guard.column), guard.name, {signal}, guard.from_ns, end, true},
        *guard.how, guard.low, guard.high, guard.place,
        seconds(static_cast<std::int64_t>(at) * truth.step_ns()));
}

void Script::judge_faults() {
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const FaultSpec& fault = faults[i];
    results::FaultRow row{
        fault.kind, fault_targets[i], seconds(fault.start_ns),
        fault.end_ns == kForever ? std::numeric_limits<double>::infinity() : seconds(fault.end_ns),
        -1.0};
    const auto it = stage_.events.faults_applied_ns.find(fault.number);
    const auto mine = stage_.world.applied_faults();
    if (it != stage_.events.faults_applied_ns.end()) {
      row.applied_s = seconds(it->second);
    } else if (std::find(mine.begin(), mine.end(), fault.number) != mine.end()) {
      row.applied_s = row.start_s;
    }
    stage_.report.faults.push_back(row);
  }
}

Result<Done> Script::finish() {
  for (const Guard& guard : guards) {
    if (guard.condition_ref == -1 && !guard.how) {
      return Error{ErrorKind::bad_input, guard.place,
                   "t:always(\"" + guard.name + "\") has no limit",
                   "add :at_most, :at_least or :within"};
    }
    judge_guard(guard);
  }
  for (const OpenWindow& window : windows_) {
    window.judge(*this, window.from_ns, std::min(window.to_ns, stage_.now_ns));
  }
  judge_faults();
  for (const PendingExpectation& e : pending) {
    if (e.judged) continue;
    return Error{ErrorKind::bad_input, e.place, "t:expect(" + e.measured.name + ") has no limit",
                 "add :at_most, :at_least, :within or :equal"};
  }
  return Done{};
}

}  // namespace whirl::plan

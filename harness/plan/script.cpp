#include "harness/plan/script.hpp"

#include <algorithm>
#include <cmath>
#include <lua.hpp>

#include "harness/plan/raise.hpp"
#include "harness/plan/requests.hpp"
#include "harness/plan/values.hpp"

namespace whirl::plan {
namespace {

constexpr const char* kOwnerKey = "whirl.script";
constexpr std::int64_t kMs_ns = 1'000'000;

// s in function(s): the signals at this step, by column name with unit ("height_m").
int read_signal(lua_State* L) {
  Script::of(L).look();
  Stage& stage = Script::of(L).stage();
  const std::string wanted = check_text(L, 2, "a signal's name");
  if (const auto column = stage.signals.find_with_unit(wanted)) {
    lua_pushnumber(L, stage.rows.last(*column));
    return 1;
  }
  if (const auto column = stage.signals.find(wanted)) {
    raise(L, "signal '" + wanted + "' is written with its unit here",
          "write s." + stage.signals.with_unit(*column));
  }
  raise(L, "unknown signal '" + wanted + "'");
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
  add_can_calls(L);
  add_action_calls(L);
  add_text_calls(L);
  add_log_calls(L);
  lua_setfield(L, -2, "__index");
  lua_pop(L, 1);
  push_handle(L, "t", 0);
}

// Times are whole nanoseconds, but 60'000'000 * 1e-9 is not 60 * 1e-3: less than a picosecond is none.
double slack(Dimension dimension) {
  return dimension == Dimension::time ? 1e-12 : 0.0;
}

// Only a finite value meets a limit.
bool meets(const Measurement& m, const std::optional<Limit>& low,
           const std::optional<Limit>& high) {
  const double x = m.value_SI, e = slack(m.dimension);
  return std::isfinite(x) && (!low || x >= low->value_SI - e) && (!high || x <= high->value_SI + e);
}

double margin_of(double x, const std::optional<Limit>& low, const std::optional<Limit>& high) {
  double margin = std::numeric_limits<double>::infinity();
  if (low) margin = std::min(margin, x - low->value_SI);
  if (high) margin = std::min(margin, high->value_SI - x);
  return std::isnan(x) ? x : margin;
}

// The value with the least margin, and the first of these; no number at all is worse than any.
Extremes::Value worst_of(const Guard& guard) {
  const Extremes& seen = guard.seen;
  if (seen.not_finite) return *seen.not_finite;
  const double low = margin_of(seen.low.x, guard.low, guard.high);
  const double high = margin_of(seen.high.x, guard.low, guard.high);
  if (low == high) return seen.low.t_ns < seen.high.t_ns ? seen.low : seen.high;
  return low < high ? seen.low : seen.high;
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

// How a time that was to be watched was not; empty: it was.
std::string unfilled(std::int64_t from_ns, std::int64_t to_ns, std::int64_t now_ns,
                     bool completed) {
  if (now_ns <= from_ns || to_ns <= from_ns) return "was never watched: its time is empty";
  if (to_ns == kForever && completed) return "";
  if (to_ns <= now_ns) return "";
  const std::string watched = std::to_string((now_ns - from_ns) / kMs_ns) + " ms";
  if (to_ns == kForever) return "the run was cut off after " + watched + " of watching";
  return "only " + watched + " of " + std::to_string((to_ns - from_ns) / kMs_ns) +
         " ms were watched when the run ended";
}

}  // namespace

void Extremes::look(double x, std::int64_t t_ns) {
  if (seen_ns == t_ns) return;
  const bool first = seen_ns < 0;
  seen_ns = t_ns;
  if (!std::isfinite(x) && !not_finite) not_finite = {x, t_ns};
  if (first || x < low.x) low = {x, t_ns};
  if (first || x > high.x) high = {x, t_ns};
}

Script& Script::of(lua_State* L) {
  lua_getfield(L, LUA_REGISTRYINDEX, kOwnerKey);
  auto* script = static_cast<Script*>(lua_touserdata(L, -1));
  lua_pop(L, 1);
  return *script;
}

Script::Script(PlanFile& file, const Plan& plan, Stage& stage) : file_(file), stage_(stage) {
  const auto started = file_.sandbox().protect(0, [&](lua_State* L) { start(L, plan); });
  if (!started) broken_ = started.error();
}

RandomStream& Script::chance() {
  if (!chance_) chance_.emplace(stage_.report.seed, "plan.drawn");
  return *chance_;
}

void Script::start(lua_State* L, const Plan& plan) {
  lua_pushlightuserdata(L, this);
  lua_setfield(L, LUA_REGISTRYINDEX, kOwnerKey);
  thread_ = lua_newthread(L);
  lua_pushvalue(L, -1);
  luaL_ref(L, LUA_REGISTRYINDEX);  // keeps the thread alive as long as the state
  lua_rawgeti(L, LUA_REGISTRYINDEX, plan.run_ref);
  push_t(L);
  lua_xmove(L, thread_, 2);
}

std::size_t Script::column(lua_State* L, const std::string& signal) {
  if (const auto column = stage_.signals.find(signal)) return *column;
  raise(L, "unknown signal '" + signal + "'", "known: " + stage_.signals.names());
}

Dimension Script::dimension(std::size_t column) const {
  return stage_.signals[column].dimension;
}

bool Script::condition(lua_State* L, int ref) {
  lua_rawgeti(L, LUA_REGISTRYINDEX, ref);
  const std::string place = place_of_function(L);
  push_signals(L);
  in_condition_ = true;
  lua_call(L, 1, 1);
  in_condition_ = false;
  if (!lua_isboolean(L, -1)) {  // to Lua 0 is true: what a signal is would hold whatever it is
    raise(L, {ErrorKind::bad_input, place,
              std::string("a condition is true or false, not a ") + luaL_typename(L, -1),
              "return s.told_armed == 1"});
  }
  const bool met = lua_toboolean(L, -1) != 0;
  lua_pop(L, 1);
  return met;
}

void Script::wait_until(std::int64_t t_ns, int condition_ref) {
  if (in_condition_)
    raise(file_.sandbox().state(), "a condition looks at a moment and cannot wait");
  wake_ns_ = t_ns;
  wake_condition_ = condition_ref;
  condition_met_ = false;
}

void Script::look_at_guarded() {
  for (Guard& guard : guards) {
    if (!guard.column || stage_.now_ns > guard.to_ns) continue;
    guard.seen.look(stage_.rows.last(*guard.column), stage_.now_ns);
  }
}

Result<Script::State> Script::advance() {
  auto state = resume();
  if (!state) return state;
  if (auto given = give_due_commands(); !given) return given.error();
  return state;
}

Result<Script::State> Script::resume() {
  if (broken_) return *broken_;
  if (done_) return State::done;
  look_at_guarded();
  lua_State* L = file_.sandbox().state();
  // Conditions run outside the coroutine, under one protected call per step.
  file_.sandbox().refill();
  const auto met = file_.sandbox().protect(0, [this](lua_State* l) { check_conditions(l); });
  if (!met) return met.error();
  if (stage_.now_ns < wake_ns_ && !condition_met_) return State::waiting;
  file_.sandbox().refill(thread_);
  int results = 0;
  const int status = lua_resume(thread_, L, started_ ? 0 : 1, &results);
  started_ = true;
  look_at_guarded();  // also those that begin now
  const auto begun =
      file_.sandbox().protect(0, [this](lua_State* l) { check_guarding_conditions(l); });
  if (status != LUA_YIELD && status != LUA_OK) return lua::Sandbox::raised(thread_, status);
  if (!begun) return begun.error();
  done_ = status == LUA_OK;
  return done_ ? State::done : State::waiting;  // no call of ours yields a value
}

Result<Done> Script::give_command(const lua::Table& table) {
  return command(stage_.world, table, stage_.now_ns,
                 [this](const std::string& name) { return file_.sandbox().read_below(name); });
}

Result<Done> Script::add_timed_command(std::int64_t t_ns, const lua::Table& table) {
  const auto commands = read_commands(
      table, [this](const std::string& name) { return file_.sandbox().read_below(name); });
  if (!commands) return commands.error();
  for (const Command& one : commands.value()) timed_.emplace(t_ns, one);
  return Done{};
}

Result<Done> Script::give_due_commands() {
  while (!timed_.empty() && timed_.begin()->first <= stage_.now_ns) {
    if (auto done = stage_.world.command(timed_.begin()->second, stage_.now_ns); !done) return done;
    timed_.erase(timed_.begin());
  }
  return Done{};
}

void Script::check_conditions(lua_State* L) {
  if (wake_condition_ != -1 && !condition_met_) condition_met_ = condition(L, wake_condition_);
  check_guarding_conditions(L);
}

void Script::check_guarding_conditions(lua_State* L) {
  const std::int64_t now = stage_.now_ns;
  // By number: a condition may set guards.
  for (std::size_t i = 0; i < guards.size(); ++i) {
    if (guards[i].condition_ref == -1 || now > guards[i].to_ns || guards[i].evaluated_ns == now) {
      continue;
    }
    guards[i].evaluated_ns = now;
    ++guards[i].evaluated;
    if (condition(L, guards[i].condition_ref)) continue;
    if (!guards[i].first_ns) guards[i].first_ns = now;
    guards[i].violated_ns += stage_.rows.step_ns();
  }
}

void Script::add(results::Expectation e) {
  // "x (2)" may also be a name that the plan wrote itself.
  const std::string base = e.name;
  int& number = last_number_.try_emplace(base, 1).first->second;
  while (!names_.insert(e.name).second) e.name = base + " (" + std::to_string(++number) + ")";
  stage_.report.expectations.push_back(std::move(e));
}

void Script::judge(const Measurement& m, How how, std::optional<Limit> low,
                   std::optional<Limit> high, const std::string& place, double t_s,
                   const std::string& note, const std::string& unfilled, double accuracy) {
  results::Expectation e;
  e.name = m.name;
  e.how = words(how);
  e.unit = high ? high->unit : low->unit;
  e.verdict = meets(m, low, high) ? results::Verdict::pass : results::Verdict::fail;
  if (!unfilled.empty() && (e.verdict == results::Verdict::pass || std::isnan(m.value_SI))) {
    e.verdict = results::Verdict::inconclusive;
  }
  e.measured = in_unit(m.value_SI, e.unit);
  if (low) e.low = in_unit(low->value_SI, e.unit);
  if (high) e.high = in_unit(high->value_SI, e.unit);
  // A margin is a difference: an offset of the unit (degC) must not enter twice.
  e.margin = in_unit(margin_of(m.value_SI, low, high), e.unit) - in_unit(0.0, e.unit);
  e.marginal =
      e.verdict == results::Verdict::pass && high && m.value_SI > high->value_SI * (1.0 - accuracy);
  e.place = place;
  e.t_s = t_s;
  e.signals = m.signals;
  e.from_s = seconds(m.from_ns);
  e.to_s = seconds(m.to_ns);
  e.level = m.level;
  if (low) e.limits_SI.push_back(low->value_SI);
  if (high && how != How::equal) e.limits_SI.push_back(high->value_SI);
  e.note = std::isnan(m.value_SI) && note.empty() ? "nothing to measure" : note;
  if (!unfilled.empty()) e.note = unfilled + (note.empty() ? "" : "; " + note);
  add(std::move(e));
}

void Script::judge_in_window(const Measurement& m, Figure figure, const Limit& high,
                             const std::string& place, double t_s, const std::string& note,
                             double accuracy) {
  Measurement known = m;
  if (figure == Figure::of_all && !unfilled_.empty()) known.value_SI = std::nan("");
  judge(known, How::at_most, std::nullopt, high, place, t_s, note, unfilled_, accuracy);
}

void Script::set_step(const std::string& name) {
  step_name_ = name;
  stage_.report.steps.push_back({seconds(stage_.now_ns), "plan", name});
}

void Script::add_window(std::int64_t to_ns, Window window) {
  windows_.push_back({stage_.now_ns, to_ns, std::move(window)});
}

void Script::judge_guard(const Guard& guard, bool completed) {
  const std::int64_t end = std::min(guard.to_ns, stage_.now_ns);
  std::string not_whole = unfilled(guard.from_ns, guard.to_ns, stage_.now_ns, completed);
  if (guard.condition_ref != -1) {
    if (guard.evaluated == 0) not_whole = "was never evaluated";
    const std::string note =
        guard.first_ns ? "first violated at " + std::to_string(seconds(*guard.first_ns)) + " s"
                       : "";
    judge({seconds(guard.violated_ns), Dimension::time, guard.name + " (time violated)"},
          How::at_most, std::nullopt, Limit{0.0, "s"}, guard.place,
          seconds(guard.first_ns.value_or(0)), note, not_whole);
    return;
  }
  look();
  const Extremes::Value worst = worst_of(guard);
  const std::string signal = stage_.rows.columns()[*guard.column].name;
  judge({worst.x, dimension(*guard.column), guard.name, {signal}, guard.from_ns, end, true},
        *guard.how, guard.low, guard.high, guard.place, seconds(worst.t_ns), "", not_whole);
}

void Script::judge_windows(bool completed) {
  for (const OpenWindow& window : windows_) {
    look();
    unfilled_ = unfilled(window.from_ns, window.to_ns, stage_.now_ns, completed);
    window.judge(*this, window.from_ns, std::min(window.to_ns, stage_.now_ns));
  }
}

void Script::list_faults() {
  for (const FaultSpec& fault : faults) {
    results::FaultRow row{
        fault.kind, stage_.nodes[fault.board].qualified(target_of(fault)), seconds(fault.start_ns),
        fault.end_ns == kForever ? std::numeric_limits<double>::infinity() : seconds(fault.end_ns)};
    const auto& applied_ns = stage_.logs[fault.board].faults_applied_ns;
    const auto it = applied_ns.find(static_cast<std::uint16_t>(fault.number));
    const auto mine = stage_.world.applied_faults();
    if (it != applied_ns.end()) {
      row.applied_s = seconds(it->second);
    } else if (std::find(mine.begin(), mine.end(), fault.number) != mine.end()) {
      row.applied_s = row.start_s;
    }
    stage_.report.faults.push_back(row);
  }
}

std::vector<Error> Script::finish(bool completed) {
  std::vector<Error> errors;
  look_at_guarded();  // of the last step
  for (const Guard& guard : guards) {
    if (guard.condition_ref != -1 || guard.how) {
      judge_guard(guard, completed);
      continue;
    }
    errors.push_back({ErrorKind::bad_input, guard.place,
                      "t:always(\"" + guard.name + "\") has no limit",
                      "add :at_most, :at_least or :within"});
  }
  if (completed && !timed_.empty()) {
    errors.push_back({ErrorKind::bad_input, stage_.report.file,
                      "t:at: " + std::to_string(timed_.size()) +
                          " commands were still to come when the plan ended",
                      "wait for the last of them"});
  }
  judge_windows(completed);
  list_faults();
  for (const PendingExpectation& e : pending) {
    if (e.judged) continue;
    errors.push_back({ErrorKind::bad_input, e.place,
                      "t:expect(" + e.measured.name + ") has no limit",
                      "add :at_most, :at_least, :within or :equal"});
  }
  return errors;
}

}  // namespace whirl::plan

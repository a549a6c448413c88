// t:wait, t:wait_until, t:within, t:step, t:log, t:value, t:now: the plan and the clock of the run.
#include <algorithm>

#include "harness/plan/raise.hpp"
#include "harness/plan/values.hpp"

namespace whirl::plan {
namespace {

int wait(lua_State* L) {
  Script& self = Script::of(L);
  self.wait_until(self.stage().now_ns + check_duration_ns(L, 2));
  return lua_yield(L, 0);
}

int keep_condition(lua_State* L, int index) {
  if (!lua_isfunction(L, index)) {
    raise(L, std::string("a condition function(s) ... end is wanted, not a ") +
                 luaL_typename(L, index));
  }
  lua_pushvalue(L, index);
  return luaL_ref(L, LUA_REGISTRYINDEX);
}

// t:wait_until(condition, timeout) -> whether it came true. No verdict: see t:within.
int wait_until(lua_State* L) {
  Script& self = Script::of(L);
  const std::int64_t end = self.stage().now_ns + check_duration_ns(L, 3);
  self.wait_until(end, keep_condition(L, 2));
  return lua_yieldk(L, 0, 0, [](lua_State* l, int, lua_KContext) {
    lua_pushboolean(l, static_cast<int>(Script::of(l).condition_met()));
    return 1;
  });
}

// t:within(limit, condition [, name]): waits for it, and expects it within the limit.
int within(lua_State* L) {
  Script& self = Script::of(L);
  const std::int64_t limit_ns = check_duration_ns(L, 2);
  const int ref = keep_condition(L, 3);
  if (!lua_isnoneornil(L, 4)) check_text(L, 4, "a name");
  lua_settop(L, 4);
  lua_pushstring(L, place_of(L).c_str());
  self.wait_until(self.stage().now_ns + limit_ns, ref);
  return lua_yieldk(L, 0, self.stage().now_ns, [](lua_State* l, int, lua_KContext since_ns) {
    Script& script = Script::of(l);
    const std::int64_t now = script.stage().now_ns;
    const bool met = script.condition_met();
    const double took_s = met ? seconds(now - since_ns) : std::numeric_limits<double>::quiet_NaN();
    const char* place = lua_tostring(l, 5);
    const std::string name =
        lua_isnil(l, 4) ? std::string("within, ") + place : std::string(lua_tostring(l, 4));
    script.judge({took_s, Dimension::time, name}, How::at_most, std::nullopt,
                 check_limit(l, 2, Dimension::time), place, seconds(now),
                 met ? "" : "never came true");
    lua_pushboolean(l, static_cast<int>(met));
    return 1;
  });
}

int step(lua_State* L) {
  Script::of(L).set_step(check_text(L, 2, "a step's name"));
  return 0;
}

// t:log(anything). A log is for people: what nobody would read is cut, with a word about it.
int log(lua_State* L) {
  constexpr std::size_t kMost_lines = 5'000, kLongest_line_B = 2'000;
  Stage& stage = Script::of(L).stage();
  auto& lines = stage.report.log;
  if (lines.size() > kMost_lines) return 0;
  std::size_t size = 0;
  const char* text = luaL_tolstring(L, 2, &size);
  std::string line(text, std::min(size, kLongest_line_B));
  if (size > line.size()) {
    line += " ... (" + std::to_string(size - line.size()) + " bytes more)";
  }
  if (lines.size() == kMost_lines) line = "the log is full: what follows is left out";
  lines.push_back({seconds(stage.now_ns), "plan", std::move(line)});
  return 0;
}

// t:value("height") -> measurement; t:value("tilt", "deg") -> a plain number in that unit.
int value(lua_State* L) {
  Script& self = Script::of(L);
  self.look();
  const std::string signal = check_text(L, 2, "a signal's name");
  const std::size_t column = self.column(L, signal);
  const double x = self.stage().rows.last(column);
  if (lua_isnoneornil(L, 3)) {
    const std::int64_t now_ns = self.stage().now_ns;
    push_measurement(L, {x, self.dimension(column), signal, {signal}, now_ns, now_ns, true});
    return 1;
  }
  const std::string unit = check_text(L, 3, "a unit");
  const auto one = parse_quantity_as("1 " + unit, self.dimension(column), "");
  if (!one) raise(L, one.error());
  lua_pushnumber(L, in_unit(x, unit));
  return 1;
}

int now(lua_State* L) {
  push_measurement(L, {seconds(Script::of(L).stage().now_ns), Dimension::time, "time"});
  return 1;
}

// t:quantity("5 cm") -> 0.05: the SI number, for arithmetic in conditions.
int quantity(lua_State* L) {
  const auto parsed = parse_quantity(check_text(L, 2, "a quantity"), "");
  if (!parsed) raise(L, parsed.error());
  lua_pushnumber(L, parsed.value().value_SI);
  return 1;
}

// t:shortest_rise { from = "0.8 N", to = "4 N", current = "20 A" } -> what that current takes of this copy.
int shortest_rise(lua_State* L) {
  const lua::Table asked = check_table(L, 2);
  const auto thrust_N = [&](const char* key) { return asked.quantity(key, Dimension::force); };
  const double from_N = thrust_N("from"), to_N = thrust_N("to");
  const double current_A = asked.quantity("current", Dimension::current, lua::above(0.0));
  check_finish(L, asked);
  const auto rise_s = Script::of(L).stage().world.shortest_rise_s(from_N, to_N, current_A);
  if (!rise_s) raise(L, rise_s.error());
  push_measurement(L, {rise_s.value(), Dimension::time, "shortest rise"});
  return 1;
}

// t:drawn("2 s", "5 s") -> "3.4715 s": even between the two, the next draw of the run's seed.
int drawn(lua_State* L) {
  Script& self = Script::of(L);
  const std::string low_text = check_text(L, 2, "a quantity");
  const auto low = parse_quantity(low_text, "");
  if (!low) raise(L, low.error());
  const auto high = parse_quantity_as(check_text(L, 3, "a quantity"), low.value().dimension, "");
  if (!high) raise(L, high.error());
  const double from = low.value().value_SI, to = high.value();
  if (!(from <= to)) raise(L, "the lower end comes first");
  const std::string unit = unit_symbol(low_text);
  char text[64];
  const double value = in_unit(from + self.chance().uniform() * (to - from), unit);
  std::snprintf(text, sizeof text, "%.9g %s", value, unit.c_str());
  lua_pushstring(L, text);
  return 1;
}

}  // namespace

void add_time_calls(lua_State* L) {
  const luaL_Reg calls[] = {{"wait", wait},     {"wait_until", wait_until},
                            {"within", within}, {"step", step},
                            {"log", log},       {"value", value},
                            {"now", now},       {"quantity", quantity},
                            {"drawn", drawn},   {"shortest_rise", shortest_rise},
                            {nullptr, nullptr}};
  luaL_setfuncs(L, calls, 0);
}

}  // namespace whirl::plan

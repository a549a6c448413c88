// t:expect(measurement) and t:always(signal or condition): what must hold, now or over a time.
#include <cmath>

#include "harness/plan/raise.hpp"
#include "harness/plan/values.hpp"

namespace whirl::plan {
namespace {

constexpr const char* kExpectation = "expectation";
constexpr const char* kGuard = "guard";
constexpr std::size_t kMost_expectations = 100'000, kMost_guards = 1'000;

struct Bounds {
  How how;
  std::optional<Limit> low, high;
};

// A limit that every figure meets, or none, judges nothing.
Limit finite_limit(lua_State* L, int index, Dimension dimension) {
  const Limit limit = check_limit(L, index, dimension);
  if (!std::isfinite(limit.value_SI)) raise(L, "a limit is a finite number");
  return limit;
}

Bounds read_bounds(lua_State* L, How how, Dimension dimension) {
  const Limit first = finite_limit(L, 2, dimension);
  switch (how) {
    case How::at_most:
      return {how, std::nullopt, first};
    case How::at_least:
      return {how, first, std::nullopt};
    case How::equal:
      return {how, first, first};
    case How::within: {
      const Limit second = finite_limit(L, 3, dimension);
      if (!(first.value_SI <= second.value_SI)) raise(L, ":within wants the lower limit first");
      return {how, first, second};
    }
  }
  return {how, std::nullopt, first};
}

// t:expect(measurement [, name])
int expect(lua_State* L) {
  Script& self = Script::of(L);
  PendingExpectation pending{check_measurement(L, 2), place_of(L), false};
  if (!lua_isnoneornil(L, 3)) pending.measured.name = check_text(L, 3, "a name");
  if (self.pending.size() >= kMost_expectations) raise(L, "more than 100000 expectations");
  self.pending.push_back(std::move(pending));
  push_handle(L, kExpectation, self.pending.size() - 1);
  return 1;
}

int judge(lua_State* L, How how) {
  Script& self = Script::of(L);
  PendingExpectation& pending = self.pending[check_handle(L, 1, kExpectation)];
  const Bounds b = read_bounds(L, how, pending.measured.dimension);
  pending.judged = true;
  self.judge(pending.measured, how, b.low, b.high, place_of(L),
             static_cast<double>(self.stage().now_ns) * 1e-9);
  lua_settop(L, 1);
  return 1;  // so that a second limit may follow
}

int bound(lua_State* L, How how) {
  Script& self = Script::of(L);
  Guard& guard = self.guards[check_handle(L, 1, kGuard)];
  if (!guard.column) raise(L, "a condition holds or not; it has no limit");
  if (guard.how) raise(L, "t:always(\"" + guard.name + "\") has its limit already");
  Bounds b = read_bounds(L, how, self.dimension(*guard.column));
  guard.how = how;
  guard.low = b.low;
  guard.high = b.high;
  lua_settop(L, 1);
  return 1;
}

template <int (*then)(lua_State*, How), How how>
int call(lua_State* L) {
  return then(L, how);
}

int stop(lua_State* L) {
  Script& self = Script::of(L);
  Guard& guard = self.guards[check_handle(L, 1, kGuard)];
  guard.to_ns = std::min(guard.to_ns, self.stage().now_ns);
  return 0;
}

// t:always("tilt" [, duration]):at_most "20 deg", or
// t:always("motors turn", function(s) return ... end [, duration]). From now on.
int always(lua_State* L) {
  Script& self = Script::of(L);
  Guard guard;
  guard.name = check_text(L, 2, "a signal's name, or a name and a condition");
  guard.place = place_of(L);
  guard.from_ns = self.stage().now_ns;
  const bool conditional = lua_isfunction(L, 3);
  const int duration = conditional ? 4 : 3;
  if (!lua_isnoneornil(L, duration)) guard.to_ns = guard.from_ns + check_duration_ns(L, duration);
  if (conditional) {
    lua_pushvalue(L, 3);
    guard.condition_ref = luaL_ref(L, LUA_REGISTRYINDEX);
  } else {
    guard.column = self.column(L, guard.name);
    guard.name += ", always";
  }
  if (self.guards.size() >= kMost_guards) raise(L, "more than 1000 guards");
  self.guards.push_back(std::move(guard));
  push_handle(L, kGuard, self.guards.size() - 1);
  return 1;
}

}  // namespace

void add_expect_calls(lua_State* L) {
  const luaL_Reg calls[] = {{"expect", expect}, {"always", always}, {nullptr, nullptr}};
  luaL_setfuncs(L, calls, 0);
  const luaL_Reg expectation[] = {{"at_most", call<judge, How::at_most>},
                                  {"at_least", call<judge, How::at_least>},
                                  {"within", call<judge, How::within>},
                                  {"equal", call<judge, How::equal>},
                                  {nullptr, nullptr}};
  declare_handle(L, kExpectation, expectation);
  const luaL_Reg guard[] = {{"at_most", call<bound, How::at_most>},
                            {"at_least", call<bound, How::at_least>},
                            {"within", call<bound, How::within>},
                            {"stop", stop},
                            {nullptr, nullptr}};
  declare_handle(L, kGuard, guard);
}

}  // namespace whirl::plan

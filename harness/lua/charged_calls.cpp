// Calls of Lua's own library that may work long for one instruction of the plan: they pay first.
#include <algorithm>
#include <lua.hpp>
#include <string>

#include "harness/lua/library.hpp"
#include "harness/lua/sandbox.hpp"

namespace whirl::lua {
namespace {

// Steps that a call with these arguments may take. Arguments of a wrong type cost nothing: the call
// itself complains about them.
using Cost = double (*)(lua_State*);

double number_or(lua_State* L, int index, double fallback) {
  return lua_isnoneornil(L, index) ? fallback : lua_tonumber(L, index);
}

double length(lua_State* L, int index) {
  return static_cast<double>(lua_rawlen(L, index));
}

double both_lengths(lua_State* L) {
  double steps = 0.0;
  for (const int index : {1, 2}) {
    if (lua_type(L, index) == LUA_TSTRING) steps += length(L, index);
  }
  return steps;
}

double table_length(lua_State* L) {
  return lua_istable(L, 1) ? length(L, 1) : 0.0;
}

// What stands behind the place, and is shifted: nothing where the call names no place.
double inserted_items(lua_State* L) {
  return lua_gettop(L) < 3 ? 0.0 : table_length(L) - number_or(L, 2, 0.0) + 1.0;
}
double removed_items(lua_State* L) {
  return lua_gettop(L) < 2 ? 0.0 : table_length(L) - number_or(L, 2, 0.0) + 1.0;
}

double concat_items(lua_State* L) {
  return number_or(L, 4, table_length(L)) - number_or(L, 3, 1.0) + 1.0;
}

double move_items(lua_State* L) {
  return number_or(L, 3, 0.0) - number_or(L, 2, 0.0) + 1.0;
}

double unpack_items(lua_State* L) {
  const double n = number_or(L, 3, table_length(L)) - number_or(L, 2, 1.0) + 1.0;
  if (n > kMost_values) luaL_error(L, "too many results to unpack");
  return n;
}

// Upvalue 1: Lua's own function.
template <Cost cost>
int charged(lua_State* L) {
  Sandbox::spend(L, std::max(cost(L), 0.0));
  const int results = lua_tocfunction(L, lua_upvalueindex(1))(L);
  if (results > kMost_values) luaL_error(L, "more than %d results", kMost_values);
  return results;
}

struct Charged {
  const char *library, *name;
  lua_CFunction call;
};
constexpr Charged kCharged[] = {
    {LUA_GNAME, "tonumber", charged<both_lengths>},
    {LUA_STRLIBNAME, "byte", charged<both_lengths>},
    {LUA_STRLIBNAME, "pack", charged<both_lengths>},
    {LUA_STRLIBNAME, "packsize", charged<both_lengths>},
    {LUA_STRLIBNAME, "unpack", charged<both_lengths>},
    {LUA_TABLIBNAME, "concat", charged<concat_items>},
    {LUA_TABLIBNAME, "insert", charged<inserted_items>},
    {LUA_TABLIBNAME, "move", charged<move_items>},
    {LUA_TABLIBNAME, "remove", charged<removed_items>},
    {LUA_TABLIBNAME, "unpack", charged<unpack_items>},
};

// string.rep(s, n [, separator])
int rep(lua_State* L) {
  std::size_t size = 0, separator_size = 0;
  const char* text_at = luaL_checklstring(L, 1, &size);
  const lua_Integer n = luaL_checkinteger(L, 2);
  const char* separator_at = luaL_optlstring(L, 3, "", &separator_size);
  if (n <= 0 || size + separator_size == 0) return lua_pushliteral(L, ""), 1;
  if (static_cast<double>(n) * static_cast<double>(size + separator_size) > kLongest_text_B) {
    return luaL_error(L, "resulting string too large");
  }
  const std::string_view text(text_at, size), separator(separator_at, separator_size);
  Sandbox::spend(L, static_cast<double>(n) / 8.0);
  std::string all(text);
  for (lua_Integer i = 1; i < n; ++i) all.append(separator).append(text);
  lua_pushlstring(L, all.data(), all.size());
  return 1;
}

// table.sort(list [, before]): a merge sort from runs of one upwards, between the list (index 1) and a
// table beside it (index 3).
constexpr int kList = 1, kBefore = 2, kBeside = 3;

// Whether the value on top of the stack comes before the one below it. Pops neither.
bool top_is_before(lua_State* L) {
  if (lua_isnil(L, kBefore)) return lua_compare(L, -1, -2, LUA_OPLT) != 0;
  lua_pushvalue(L, kBefore);
  lua_pushvalue(L, -2);
  lua_pushvalue(L, -4);
  lua_call(L, 2, 1);
  const bool before = lua_toboolean(L, -1) != 0;
  lua_pop(L, 1);
  return before;
}

// [low, middle) and [middle, high) of one table, each in order, into the other.
void merge(lua_State* L, int from, int to, lua_Integer low, lua_Integer middle, lua_Integer high) {
  lua_Integer left = low, right = middle;
  for (lua_Integer at = low; at < high; ++at) {
    Sandbox::spend(L, 1.0);
    bool take_right = left == middle;
    if (!take_right && right < high) {
      lua_rawgeti(L, from, left);
      lua_rawgeti(L, from, right);
      take_right = top_is_before(L);
      lua_pop(L, 2);
    }
    lua_rawgeti(L, from, take_right ? right++ : left++);
    lua_rawseti(L, to, at);
  }
}

int sort(lua_State* L) {
  luaL_checktype(L, kList, LUA_TTABLE);
  if (!lua_isnoneornil(L, kBefore)) luaL_checktype(L, kBefore, LUA_TFUNCTION);
  lua_settop(L, kBefore);
  lua_newtable(L);
  const auto n = static_cast<lua_Integer>(lua_rawlen(L, kList));
  int from = kList, to = kBeside;
  for (lua_Integer width = 1; width < n; width *= 2) {
    for (lua_Integer low = 1; low <= n; low += 2 * width) {
      merge(L, from, to, low, std::min(low + width, n + 1), std::min(low + 2 * width, n + 1));
    }
    std::swap(from, to);
  }
  for (lua_Integer i = 1; from != kList && i <= n; ++i) {
    lua_rawgeti(L, from, i);
    lua_rawseti(L, kList, i);
  }
  return 0;
}

void set(lua_State* L, const char* library, const char* name, lua_CFunction call, int upvalues) {
  lua_pushcclosure(L, call, upvalues);
  lua_getglobal(L, library);
  lua_insert(L, -2);
  lua_setfield(L, -2, name);
  lua_pop(L, 1);
}

}  // namespace

void open_charged_calls(lua_State* L) {
  for (const Charged& c : kCharged) {
    lua_getglobal(L, c.library);
    lua_getfield(L, -1, c.name);
    lua_remove(L, -2);
    set(L, c.library, c.name, c.call, 1);
  }
  set(L, LUA_STRLIBNAME, "rep", rep, 0);
  set(L, LUA_TABLIBNAME, "sort", sort, 0);
}

}  // namespace whirl::lua

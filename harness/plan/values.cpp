#include "harness/plan/values.hpp"

#include <cstdio>

#include "harness/lua/node.hpp"
#include "harness/plan/raise.hpp"

namespace whirl::plan {
namespace {

constexpr const char* kMeasurement = "measurement";
constexpr std::size_t kMost_measurements = 1'000'000;
constexpr std::size_t kLongest_text_B = 4096;

std::string text_at(lua_State* L, int index) {
  std::size_t size = 0;
  const char* text = lua_tolstring(L, index, &size);
  return {text, size};
}

int show_measurement(lua_State* L) {
  const Measurement m = check_measurement(L, 1);
  char text[64];
  std::snprintf(text, sizeof text, "%.6g %s", m.value_SI, si_symbol(m.dimension));
  lua_pushstring(L, text);
  return 1;
}

}  // namespace

void declare_measurement(lua_State* L) {
  luaL_newmetatable(L, kMeasurement);
  lua_pushcfunction(L, show_measurement);
  lua_setfield(L, -2, "__tostring");
  lua_pop(L, 1);
}

void push_measurement(lua_State* L, const Measurement& m) {
  auto& all = Script::of(L).measurements;
  if (all.size() >= kMost_measurements) raise(L, "more than a million measurements");
  lua_newtable(L);
  lua_pushnumber(L, m.value_SI);
  lua_setfield(L, -2, "value");
  lua_pushlstring(L, m.name.data(), m.name.size());
  lua_setfield(L, -2, "name");
  lua_pushinteger(L, static_cast<lua_Integer>(all.size()));
  lua_setfield(L, -2, "number");
  luaL_setmetatable(L, kMeasurement);
  all.push_back(m);
}

Measurement check_measurement(lua_State* L, int index) {
  if (lua_type(L, index) == LUA_TNUMBER) return {lua_tonumber(L, index), Dimension::none, "value"};
  bool ours = false;
  if (lua_istable(L, index) && lua_getmetatable(L, index) != 0) {
    luaL_getmetatable(L, kMeasurement);
    ours = lua_rawequal(L, -1, -2) != 0;
    lua_pop(L, 2);
  }
  if (!ours) {
    raise(L, std::string("a measurement or a number is wanted, not a ") + luaL_typename(L, index));
  }
  lua_getfield(L, index, "number");
  const auto number = static_cast<std::size_t>(lua_tointeger(L, -1));
  lua_pop(L, 1);
  const auto& all = Script::of(L).measurements;
  if (number >= all.size()) raise(L, "this measurement has been changed");
  return all[number];
}

Limit check_limit(lua_State* L, int index, Dimension wanted) {
  if (lua_type(L, index) == LUA_TNUMBER && wanted == Dimension::none) {
    return {lua_tonumber(L, index), ""};
  }
  if (lua_type(L, index) != LUA_TSTRING) {
    raise(L, std::string("a ") + name(wanted) + " as a text is wanted, not a " +
                 luaL_typename(L, index));
  }
  const std::string text = text_at(L, index);
  const auto value = parse_quantity_as(text, wanted, "");
  if (!value) raise(L, value.error());
  return {value.value(), unit_symbol(text)};
}

std::int64_t check_duration_ns(lua_State* L, int index) {
  const std::string text = check_text(L, index, "a duration such as \"1 s\"");
  const auto ns = parse_duration_ns(text, "");
  if (!ns) raise(L, ns.error());
  if (ns.value() < 1'000'000) raise(L, "'" + text + "' is shorter than a step of 1 ms");
  return ns.value();
}

std::string check_text(lua_State* L, int index, const char* what) {
  if (lua_type(L, index) != LUA_TSTRING) {
    raise(L, std::string(what) + " is wanted, not a " + luaL_typename(L, index));
  }
  std::string text = text_at(L, index);
  if (text.size() > kLongest_text_B) {
    raise(L, std::string(what) + " of " + std::to_string(text.size()) + " bytes",
          "4096 are enough");
  }
  return text;
}

lua::Table check_table(lua_State* L, int index) {
  if (!lua_istable(L, index)) {
    raise(L, std::string("a table { ... } is wanted, not a ") + luaL_typename(L, index));
  }
  const auto tree = lua::tree_from_stack(L, index, "", "", place_of(L));
  if (!tree) raise(L, tree.error());
  return {tree.value(), &tree.value()->root};
}

void check_finish(lua_State* L, const lua::Table& table) {
  if (auto good = table.finish(); !good) raise(L, good.error());
}

void push_handle(lua_State* L, const char* type, std::size_t number) {
  *static_cast<std::size_t*>(lua_newuserdatauv(L, sizeof number, 0)) = number;
  luaL_setmetatable(L, type);
}

std::size_t check_handle(lua_State* L, int index, const char* type) {
  const auto* number = static_cast<std::size_t*>(luaL_testudata(L, index, type));
  if (number == nullptr) raise(L, std::string("call it with a colon, as ") + type + ":method()");
  return *number;
}

void declare_handle(lua_State* L, const char* type, const luaL_Reg* methods) {
  luaL_newmetatable(L, type);
  lua_newtable(L);
  luaL_setfuncs(L, methods, 0);
  lua_setfield(L, -2, "__index");
  lua_pop(L, 1);
}

}  // namespace whirl::plan

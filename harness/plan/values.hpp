// Between Lua values and ours: measurements, limits, durations, handles. Internal to harness/plan.
#pragma once
#include <cstdint>
#include <lua.hpp>
#include <string>

#include "harness/lua/table.hpp"
#include "harness/plan/script.hpp"

namespace whirl::plan {

inline double seconds(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-9;
}

// A measurement is a table { value = SI, name = ..., number = ... }, the whole of it is in
// Script::measurements; a bare number is one without a dimension.
void push_measurement(lua_State* L, const Measurement& measurement);
Measurement check_measurement(lua_State* L, int index);
void declare_measurement(lua_State* L);

// "50 ms" in the wanted dimension; raises otherwise.
Limit check_limit(lua_State* L, int index, Dimension wanted);
std::int64_t check_duration_ns(lua_State* L, int index);  // at least 1 ms: a step
std::string check_text(lua_State* L, int index, const char* what);
// The table at index as data, with the plan's line as its place.
lua::Table check_table(lua_State* L, int index);
void check_finish(lua_State* L, const lua::Table& table);  // raises its first complaint

// Objects of ours in Lua: a number behind a type name with methods.
void push_handle(lua_State* L, const char* type, std::size_t number);
std::size_t check_handle(lua_State* L, int index, const char* type);
void declare_handle(lua_State* L, const char* type, const luaL_Reg* methods);

}  // namespace whirl::plan

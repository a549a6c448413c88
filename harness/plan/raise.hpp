// Errors from C++ into Lua: with the line of the plan that called.
#pragma once
#include <string>

#include "base/result.hpp"

struct lua_State;

namespace whirl::plan {

std::string place_of(lua_State* L);  // "hover.lua:12", of the plan's innermost line
std::string place_of_function(
    lua_State* L);  // of the one on top of the stack, which stays: where it begins
// A place that the error brings wins.
[[noreturn]] void raise(lua_State* L, const Error& error);
[[noreturn]] void raise(lua_State* L, const std::string& what, const std::string& cure = {});

}  // namespace whirl::plan

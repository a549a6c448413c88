// Errors from C++ into Lua: with the line of the plan that called.
#pragma once
#include <string>

#include "base/result.hpp"

struct lua_State;

namespace whirl::plan {

std::string place_of(lua_State* L);  // "hover.lua:12", of the plan's innermost line
// Of the function on top of the stack, which stays: where it begins.
std::string place_of_function(lua_State* L);
// A place that the error brings wins.
[[noreturn]] void raise(lua_State* L, const Error& error);
[[noreturn]] void raise(lua_State* L, const std::string& what, const std::string& cure = {});

}  // namespace whirl::plan

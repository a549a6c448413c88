#include "harness/plan/raise.hpp"

#include <cstdlib>
#include <lua.hpp>

namespace whirl::plan {

std::string place_of(lua_State* L) {
  lua_Debug frame;
  for (int level = 1; lua_getstack(L, level, &frame) != 0; ++level) {
    lua_getinfo(L, "Sl", &frame);
    if (frame.currentline > 0) {
      return std::string(frame.short_src) + ":" + std::to_string(frame.currentline);
    }
  }
  return {};
}

std::string place_of_function(lua_State* L) {
  lua_Debug function;
  lua_pushvalue(L, -1);
  lua_getinfo(L, ">S", &function);
  if (function.linedefined <= 0) return {};
  return std::string(function.short_src) + ":" + std::to_string(function.linedefined);
}

void raise(lua_State* L, const Error& error) {
  Error placed = error;
  if (placed.place.empty()) placed.place = place_of(L);
  const std::string message = placed.message();
  lua_pushlstring(L, message.data(), message.size());
  lua_error(L);
  std::abort();  // Lua declares it as if it returned
}

void raise(lua_State* L, const std::string& what, const std::string& cure) {
  raise(L, Error{ErrorKind::bad_input, "", what, cure});
}

}  // namespace whirl::plan

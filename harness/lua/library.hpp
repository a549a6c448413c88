// What the sandbox puts in the place of Lua's own calls, so that its limits bound every one of them.
#pragma once

struct lua_State;

namespace whirl::lua {

inline constexpr int kMost_values = 1'000;  // arguments or results of one call

// string and table: a call that may work long pays for it first; sort is stable, and asks no clock for
// its pivots as Lua's own does.
void open_charged_calls(lua_State* L);
// string.find, match, gmatch and gsub, by the patterns of pattern.hpp.
void open_pattern_calls(lua_State* L);

// Replaces what prints addresses or walks in hash order, and takes away what is left. Lua; runs last.
extern const char* const kPrelude;

}  // namespace whirl::lua

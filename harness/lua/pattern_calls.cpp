// string.find, match, gmatch, gsub: arguments and results as in Lua 5.4.
#include <algorithm>
#include <cstring>
#include <lua.hpp>
#include <string>

#include "harness/lua/library.hpp"
#include "harness/lua/pattern.hpp"
#include "harness/lua/sandbox.hpp"

namespace whirl::lua {
namespace {

std::string_view check_view(lua_State* L, int index) {
  std::size_t size = 0;
  const char* text = luaL_checklstring(L, index, &size);
  return {text, size};
}

// Where a search begins: 1 is the first character, -1 the last; more than one behind it: size + 1.
std::size_t first_index(lua_State* L, int index, std::size_t size) {
  const lua_Integer i = luaL_optinteger(L, index, 1);
  const auto length = static_cast<lua_Integer>(size);
  if (i > length + 1) return size + 1;
  if (i > 0) return static_cast<std::size_t>(i - 1);
  return i == 0 || i < -length ? 0 : static_cast<std::size_t>(length + i);
}

bool is_plain(std::string_view pattern) {
  return pattern.find_first_of("^$*+?.([%-") == std::string_view::npos;
}

int find_plain(lua_State* L, std::string_view text, std::string_view wanted, std::size_t from) {
  Sandbox::spend(L, static_cast<double>(text.size() - from) / 16.0);
  const void* found = memmem(text.data() + from, text.size() - from, wanted.data(), wanted.size());
  if (found == nullptr) return lua_pushnil(L), 1;
  const auto at = static_cast<const char*>(found) - text.data();
  lua_pushinteger(L, at + 1);
  lua_pushinteger(L, at + static_cast<lua_Integer>(wanted.size()));
  return 2;
}

int search(lua_State* L, bool find) {
  const std::string_view text = check_view(L, 1);
  std::string_view pattern = check_view(L, 2);
  std::size_t at = first_index(L, 3, text.size());
  if (at > text.size()) return lua_pushnil(L), 1;
  if (find && (lua_toboolean(L, 4) != 0 || is_plain(pattern))) {
    return find_plain(L, text, pattern, at);
  }
  const bool anchored = !pattern.empty() && pattern[0] == '^';
  if (anchored) pattern.remove_prefix(1);
  Matcher matcher(L, text, pattern);
  for (; at <= text.size(); ++at) {
    if (const auto end = matcher.match(at)) {
      if (!find) return matcher.push_captures(at, *end, true);
      lua_pushinteger(L, static_cast<lua_Integer>(at) + 1);
      lua_pushinteger(L, static_cast<lua_Integer>(*end));
      return 2 + matcher.push_captures(at, *end, false);
    }
    if (anchored) break;
  }
  return lua_pushnil(L), 1;
}

int find(lua_State* L) {
  return search(L, true);
}
int match(lua_State* L) {
  return search(L, false);
}

// Upvalues of the iterator: text, pattern, where to go on, the end of the last match (-1: none yet).
int gmatch_next(lua_State* L) {
  const std::string_view text = check_view(L, lua_upvalueindex(1));
  Matcher matcher(L, text, check_view(L, lua_upvalueindex(2)));
  const lua_Integer last = lua_tointeger(L, lua_upvalueindex(4));
  auto at = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(3)));
  for (; at <= text.size(); ++at) {
    const auto end = matcher.match(at);
    if (!end || static_cast<lua_Integer>(*end) == last) continue;
    for (const int upvalue : {3, 4}) {
      lua_pushinteger(L, static_cast<lua_Integer>(*end));
      lua_replace(L, lua_upvalueindex(upvalue));
    }
    return matcher.push_captures(at, *end, true);
  }
  return 0;
}

int gmatch(lua_State* L) {
  const std::string_view text = check_view(L, 1);
  check_view(L, 2);
  const std::size_t at = first_index(L, 3, text.size());
  lua_settop(L, 2);
  lua_pushinteger(L, static_cast<lua_Integer>(at));
  lua_pushinteger(L, -1);
  lua_pushcclosure(L, gmatch_next, 4);
  return 1;
}

// The text that gsub makes.
class Output {
 public:
  explicit Output(lua_State* L) : L_(L) {}
  void add(std::string_view piece) {
    Sandbox::spend(L_, 1.0 + static_cast<double>(piece.size()) / 16.0);
    text_ += piece;
    if (text_.size() > kLongest_text_B) luaL_error(L_, "resulting string too large");
  }
  void add_value() {  // what is on top of the stack, which is popped
    std::size_t size = 0;
    const char* text = luaL_tolstring(L_, -1, &size);
    add({text, size});
    lua_pop(L_, 2);
  }
  void push() const { lua_pushlstring(L_, text_.data(), text_.size()); }

 private:
  lua_State* L_;
  std::string text_;
};

struct Match {
  const Matcher& matcher;
  std::string_view text;
  std::size_t begin, end;
};

void add_template(lua_State* L, const Match& m, Output& out) {
  const std::string_view form = check_view(L, 3);
  for (std::size_t i = 0; i < form.size();) {
    const std::size_t percent = std::min(form.find('%', i), form.size());
    if (percent > i) out.add(form.substr(i, percent - i));
    if (percent == form.size()) return;
    const char next = percent + 1 < form.size() ? form[percent + 1] : '\0';
    if (next == '%') {
      out.add("%");
    } else if (next == '0') {
      out.add(m.text.substr(m.begin, m.end - m.begin));
    } else if (next >= '1' && next <= '9') {
      m.matcher.push_capture(next - '1', m.begin, m.end);
      out.add_value();
    } else {
      luaL_error(L, "invalid use of '%%' in replacement string");
    }
    i = percent + 2;
  }
}

void add_replacement(lua_State* L, const Match& m, Output& out) {
  switch (lua_type(L, 3)) {
    case LUA_TFUNCTION: {
      lua_pushvalue(L, 3);
      const int n = m.matcher.push_captures(m.begin, m.end, true);
      lua_call(L, n, 1);
      break;
    }
    case LUA_TTABLE:
      m.matcher.push_capture(0, m.begin, m.end);
      lua_gettable(L, 3);
      break;
    default:
      return add_template(L, m, out);
  }
  if (lua_toboolean(L, -1) == 0) {  // nil or false keeps what was there
    lua_pop(L, 1);
    return out.add(m.text.substr(m.begin, m.end - m.begin));
  }
  if (lua_isstring(L, -1) == 0) {
    luaL_error(L, "invalid replacement value (a %s)", luaL_typename(L, -1));
  }
  out.add_value();
}

int gsub(lua_State* L) {
  const std::string_view text = check_view(L, 1);
  std::string_view pattern = check_view(L, 2);
  const int kind = lua_type(L, 3);
  luaL_argexpected(
      L, kind == LUA_TNUMBER || kind == LUA_TSTRING || kind == LUA_TTABLE || kind == LUA_TFUNCTION,
      3, "string/function/table");
  const lua_Integer most = luaL_optinteger(L, 4, static_cast<lua_Integer>(text.size()) + 1);
  const bool anchored = !pattern.empty() && pattern[0] == '^';
  if (anchored) pattern.remove_prefix(1);
  Matcher matcher(L, text, pattern);
  Output out(L);
  std::size_t at = 0;
  std::optional<std::size_t> last;
  lua_Integer n = 0;
  while (n < most) {
    const auto end = matcher.match(at);
    if (end && end != last) {
      ++n;
      add_replacement(L, {matcher, text, at, *end}, out);
      at = *end;
      last = end;
    } else if (at < text.size()) {
      out.add(text.substr(at++, 1));
    } else {
      break;
    }
    if (anchored) break;
  }
  out.add(text.substr(at));
  out.push();
  lua_pushinteger(L, n);
  return 2;
}

}  // namespace

void open_pattern_calls(lua_State* L) {
  const luaL_Reg calls[] = {
      {"find", find}, {"match", match}, {"gmatch", gmatch}, {"gsub", gsub}, {nullptr, nullptr}};
  lua_getglobal(L, LUA_STRLIBNAME);
  luaL_setfuncs(L, calls, 0);
  lua_pop(L, 1);
}

}  // namespace whirl::lua

// Our patterns against those of Lua itself.
#include <gtest/gtest.h>

#include <cstring>
#include <lua.hpp>
#include <memory>

#include "base/random.hpp"
#include "harness/lua/sandbox.hpp"

namespace whirl::lua {
namespace {

// What the chunk says of a text and a pattern: all results of each call, or the error's words.
constexpr const char* kAsk = R"(
local function all(...)
  local n, out = select('#', ...), {...}
  for i = 1, n do out[i] = tostring(out[i]) end
  return table.concat(out, '|', 1, n)
end
local function ask(f, ...)
  return all(select(2, pcall(f, ...)))
end
local text, pattern = ...
local words = {}
local walked = ask(function() for a, b in text:gmatch(pattern) do words[#words + 1] = all(a, b) end return '' end)
return table.concat({ ask(string.find, text, pattern), ask(string.find, text, pattern, -3),
  ask(string.find, text, pattern, 2, true), ask(string.match, text, pattern, 2),
  ask(string.gsub, text, pattern, '<%0>'), ask(string.gsub, text, pattern, '%1', 2),
  ask(string.gsub, text, pattern, { a = 'A', b = false }),
  ask(string.gsub, text, pattern, function(x) return x ~= 'a' and '!' end),
  walked, table.concat(words, ';') }, ' # ')
)";

std::string answer(lua_State* L, const std::string& text, const std::string& pattern) {
  if (luaL_loadbufferx(L, kAsk, std::strlen(kAsk), "=ask", "t") != LUA_OK) return "no chunk";
  lua_pushlstring(L, text.data(), text.size());
  lua_pushlstring(L, pattern.data(), pattern.size());
  if (lua_pcall(L, 2, 1, 0) != LUA_OK) return std::string("error: ") + lua_tostring(L, -1);
  std::size_t size = 0;
  const char* all = lua_tolstring(L, -1, &size);
  std::string said(all, size);
  lua_pop(L, 1);
  return said;
}

TEST(Patterns, AgreeWithLuasOwnOnTextsAndPatternsOfAllKinds) {
  const std::unique_ptr<lua_State, void (*)(lua_State*)> plain(luaL_newstate(), lua_close);
  luaL_openlibs(plain.get());
  Sandbox sandbox;
  constexpr const char* kPieces[] = {"a",  "b",    "ab",    ".",     "%a",   "%A",     "%d", "%s",
                                     "%w", "%p",   "%x",    "%u",    "%%",   "%.",     "*",  "+",
                                     "-",  "?",    "(",     ")",     "()",   "[",      "]",  "[^",
                                     "^",  "$",    "[a-c]", "[%d_]", "%b()", "%f[%w]", "%1", "%2",
                                     "%f", "[]a]", "[^%s]", "%b",    "%",    "1",      "_",  "%9"};
  constexpr const char* kTexts[] = {"",        "a",      "aab",  "(a(b)a)",
                                    "a1 b_2 ", "abcabc", "%.[]", "AB\x80"};
  RandomStream random(7, "patterns");
  std::string pattern;
  for (int i = 0; i < 8'000; ++i) {
    pattern.clear();
    const std::uint32_t pieces = random.bits() % 7;
    for (std::uint64_t k = 0; k < pieces; ++k)
      pattern += kPieces[random.bits() % std::size(kPieces)];
    const std::string text = std::string(kTexts[random.bits() % std::size(kTexts)]) +
                             kTexts[random.bits() % std::size(kTexts)];
    sandbox.refill();
    ASSERT_EQ(answer(sandbox.state(), text, pattern), answer(plain.get(), text, pattern))
        << "'" << text << "' by '" << pattern << "'";
  }
}

TEST(Patterns, KnowHowDeepAndHowManyAsLuaDoes) {
  const std::unique_ptr<lua_State, void (*)(lua_State*)> plain(luaL_newstate(), lua_close);
  luaL_openlibs(plain.get());
  Sandbox sandbox;
  std::string deep, groups, optional;
  for (int i = 0; i < 220; ++i) {
    deep += "a*";
    optional += "b?";
  }
  for (int i = 0; i < 33; ++i) groups += "()";
  for (const std::string& pattern : {deep, groups, optional, std::string("\0a\0", 3)}) {
    const std::string text("aaaaaaa\0a\0a", 11);
    EXPECT_EQ(answer(sandbox.state(), text, pattern), answer(plain.get(), text, pattern));
  }
}

}  // namespace
}  // namespace whirl::lua

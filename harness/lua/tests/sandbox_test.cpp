#include "harness/lua/sandbox.hpp"

#include <gtest/gtest.h>

#include <lua.hpp>
#include <stdexcept>

namespace whirl::lua {
namespace {

// What the chunk returns, as a text; or "error: ..." with the message.
std::string eval(const std::string& text) {
  Sandbox sandbox({.instructions = 2'000'000, .memory_B = 16u << 20});
  const auto ran = sandbox.run_text(text, "plans/p.lua");
  if (!ran) return "error: " + ran.error().message();
  return luaL_tolstring(sandbox.state(), -1, nullptr);
}

TEST(Sandbox, HasNoWayOut) {
  for (const char* name : {"io", "os", "require", "load", "loadfile", "dofile", "debug", "package",
                           "coroutine", "next", "collectgarbage", "getmetatable", "print",
                           "math.random", "string.dump", "rawset"}) {
    EXPECT_EQ(eval(std::string("return ") + name), "nil") << name;
  }
}

TEST(Sandbox, PairsGoesInTheOrderOfTheKeys) {
  EXPECT_EQ(eval("local s = '' for k in pairs{z=1, a=1, m=1, [2]=1, [1]=1, [true]=1} do "
                 "s = s .. tostring(k) .. ' ' end return s"),
            "1 2 a m z true ");
}

TEST(Sandbox, PrintsNoAddress) {
  EXPECT_EQ(eval("return tostring({}) .. tostring(pairs)"), "tablefunction");
  EXPECT_EQ(eval("return string.format('%s %s', {}, 3)"), "table 3");
  EXPECT_EQ(eval("return ('%s'):format(tostring)"), "function");
  EXPECT_NE(eval("return string.format('%p', {})").find("address"), std::string::npos);
}

TEST(Sandbox, EndlessLoopIsOneErrorWithItsPlace) {
  const std::string got = eval("local x = 0\nwhile true do\n  x = x + 1\nend");
  EXPECT_EQ(got.rfind("error: p.lua:", 0), 0u) << got;
  EXPECT_NE(got.find("endless loop?"), std::string::npos) << got;
}

TEST(Sandbox, NoProtectedCallOutlivesTheLimit) {
  const std::string got = eval("while true do pcall(function() while true do end end) end");
  EXPECT_NE(got.find("endless loop?"), std::string::npos) << got;
}

TEST(Sandbox, MemoryIsBounded) {
  EXPECT_EQ(eval("local t = {} for i = 1, 1e9 do t[i] = { i } end"),
            "error: p.lua: not enough memory: a plan has 16 MiB, and a text 1 MiB");
}

// Each of these is one call, or few, that would work for minutes to years.
TEST(Sandbox, NoSingleCallOutlivesTheBudget) {
  for (const char* endless : {
           "return string.find(('a'):rep(1e5), ('.-'):rep(50) .. 'b')",
           "return ('a'):rep(3e5):gsub('.-b', 'x')",
           "return ('a'):rep(3e5):match('.-.-b')",
           "for w in ('a'):rep(3e5):gmatch('.-b') do end",
           "return ('('):rep(3e5):find('%b()')",
           "return ('a'):rep(3e5):find(('[' .. ('b'):rep(1e5) .. ']'))",
           "return table.move({}, 1, math.maxinteger - 1, 2)",
           "return table.move({}, math.mininteger, math.maxinteger - 1, 2)",
           "local t = {} for i = 1, 2e5 do t[i] = '' end while true do table.concat(t) end",
           "local t = {} for i = 1, 2e5 do t[i] = i end while true do table.insert(t, 1, 1) end",
           "local t = {} for i = 1, 2e5 do t[i] = i end while true do table.remove(t, 1) end",
           "local t = {} for i = 1, 2e5 do t[i] = i % 7 end while true do table.sort(t) end",
           "local s = ('x'):rep(1e6) while true do local t = s .. 'y' end",
           "local s = (' '):rep(1e6) while true do tonumber(s) end",
           "local s = (' '):rep(1e5) while true do pcall(function() return s + 1 end) end",
           "local s = ('b'):rep(1e6) while true do string.packsize(s) end",
           "local s = ('x'):rep(1e6) while true do pcall(string.rep, s, 2) end",
           "local function f() pcall(f) pcall(f) end f()",
       }) {
    EXPECT_NE(eval(endless).find("endless loop?"), std::string::npos) << endless << eval(endless);
  }
}

TEST(Sandbox, TextsAndArgumentListsAreBounded) {
  EXPECT_EQ(eval("return (''):rep(math.maxinteger)"), "");
  EXPECT_EQ(eval("return ('ab'):rep(3, '-')"), "ab-ab-ab");
  EXPECT_NE(eval("return ('x'):rep(1 << 26)").find("string too large"), std::string::npos);
  EXPECT_NE(eval("return ('x'):rep(1 << 20):gsub('.*', '%0%0')").find("string too large"),
            std::string::npos);
  EXPECT_NE(eval("return table.unpack({}, 1, 5000)").find("too many results"), std::string::npos);
  EXPECT_NE(eval("return ('x'):rep(5000):byte(1, -1)").find("1000 results"), std::string::npos);
  EXPECT_EQ(eval("local function f(...) return f(1, ...) end f()"),
            "error: p.lua:1: a call with more than 1000 arguments");
}

TEST(Sandbox, TheStopNamesThePlansLineAlsoInsideOfOurOwnLua) {
  EXPECT_EQ(eval("local t = {}\nfor i = 1, 1e5 do t[i] = i end\nwhile true do\n  pairs(t)\nend")
                .rfind("error: p.lua:4: endless loop?", 0),
            0u);
}

TEST(Sandbox, SortKeepsTheOrderOfEquals) {
  EXPECT_EQ(eval("local t = {} for i = 1, 300 do t[i] = { i % 3, i } end "
                 "table.sort(t, function(a, b) return a[1] < b[1] end) "
                 "for i = 2, 300 do local a, b = t[i - 1], t[i] "
                 "if a[1] > b[1] or (a[1] == b[1] and a[2] > b[2]) then return 'wrong' end end "
                 "return t[1][2] .. ' ' .. t[300][2]"),
            "3 299");
  EXPECT_EQ(eval("local t = { 3, 1, 2 } table.sort(t) return table.concat(t, ' ')"), "1 2 3");
  EXPECT_NE(eval("table.sort { 1, 'a' }").find("attempt to compare"), std::string::npos);
}

// An address would differ from run to run.
TEST(Sandbox, AnErrorThatIsNoTextSaysSo) {
  EXPECT_EQ(eval("error({})"),
            "error: p.lua: error was called with a table, not with a text (write it as: error "
            "\"what is wrong\")");
  EXPECT_NE(eval("error()").find("called with a nil"), std::string::npos);
}

TEST(Sandbox, WhatIsRaisedUnderProtectionIsAnError) {
  Sandbox sandbox({.memory_B = 1u << 20});
  const auto full = sandbox.protect(0, [](lua_State* L) {
    lua_newtable(L);
    for (int i = 1;; ++i) {
      lua_newtable(L);
      lua_rawseti(L, -2, i);
    }
  });
  EXPECT_NE(full.error().what.find("not enough memory"), std::string::npos);
  const auto broken = sandbox.protect(0, [](lua_State*) { throw std::runtime_error("ours"); });
  EXPECT_EQ(broken.error().kind, ErrorKind::internal);
  EXPECT_NE(broken.error().what.find("ours"), std::string::npos);
  EXPECT_TRUE(sandbox.protect(0, [](lua_State*) {}).ok());
}

TEST(Sandbox, SyntaxErrorsCarryFileAndLine) {
  EXPECT_EQ(eval("x =\n=").rfind("error: p.lua:2: ", 0), 0u);
}

TEST(Sandbox, IncludeStaysBelowTheFolder) {
  EXPECT_NE(eval("return include '../../etc/passwd'").find("only files below"), std::string::npos);
  EXPECT_NE(eval("return include 'a\\0b'").find("only files below"), std::string::npos);
  EXPECT_NE(eval("return include(('x'):rep(5000))").find("include"), std::string::npos);
  EXPECT_NE(eval("return include '/etc/passwd'").find("only files below"), std::string::npos);
}

TEST(Sandbox, ErrorsWithoutAPlaceKeepTheirText) {
  EXPECT_EQ(Sandbox::to_error("plain: words").message(), "plain: words");
  EXPECT_EQ(Sandbox::to_error("a.lua:3: oops").place, "a.lua:3");
}

}  // namespace
}  // namespace whirl::lua

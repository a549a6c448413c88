#include "harness/lua/sandbox.hpp"

#include <gtest/gtest.h>

#include <lua.hpp>

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
  EXPECT_NE(eval("return #string.rep('x', 1 << 26)").find("not enough memory"), std::string::npos);
}

TEST(Sandbox, SyntaxErrorsCarryFileAndLine) {
  EXPECT_EQ(eval("x =\n=").rfind("error: p.lua:2: ", 0), 0u);
}

TEST(Sandbox, IncludeStaysBelowTheFolder) {
  EXPECT_NE(eval("return include '../../etc/passwd'").find("only files below"), std::string::npos);
  EXPECT_NE(eval("return include '/etc/passwd'").find("only files below"), std::string::npos);
}

TEST(Sandbox, ErrorsWithoutAPlaceKeepTheirText) {
  EXPECT_EQ(Sandbox::to_error("plain: words").message(), "plain: words");
  EXPECT_EQ(Sandbox::to_error("a.lua:3: oops").place, "a.lua:3");
}

}  // namespace
}  // namespace whirl::lua

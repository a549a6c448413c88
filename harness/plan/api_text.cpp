// t:ask: a line to the firmware's terminal, and its answer. t:told: words that the firmware says by itself.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "harness/lua/pattern.hpp"
#include "harness/plan/raise.hpp"
#include "harness/plan/requests.hpp"
#include "harness/plan/values.hpp"

namespace whirl::plan {
namespace {

// Arguments, by their place on the coroutine's stack.
constexpr int kLine = 2, kPattern = 3, kLimit = 4, kPlace = 5, kHeard = 6, kSince = 7;

// A condition for Script::wait_until: more has been heard than the upvalue says.
int heard_more(lua_State* L) {
  const auto before = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(1)));
  lua_pushboolean(L, static_cast<int>(Script::of(L).stage().world.heard().size() > before));
  return 1;
}

bool matches(lua_State* L, const std::string& text) {
  return lua_isnil(L, kPattern) ||
         lua::pattern_found(L, text, check_text(L, kPattern, "a pattern"));
}

// For a name: history and JUnit know an expectation by it from run to run, and a number in the line may
// be one that was measured, a constant of a calibration.
std::string without_numbers(const std::string& line) {
  std::istringstream words(line);
  std::string all, word;
  while (words >> word) {
    char* rest = nullptr;
    std::strtod(word.c_str(), &rest);
    all += (all.empty() ? "" : " ") + (*rest == '\0' ? "#" : word);
  }
  return all;
}

int answered(lua_State* L, int, lua_KContext ref) {
  luaL_unref(L, LUA_REGISTRYINDEX, static_cast<int>(ref));
  Script& self = Script::of(L);
  self.look();
  const auto& heard = self.stage().world.heard();
  const auto before = static_cast<std::size_t>(lua_tointeger(L, kHeard));
  const bool came = heard.size() > before;
  const std::string answer = came ? heard[before] : "";
  const bool good = came && matches(L, answer);
  const std::int64_t now_ns = self.stage().now_ns;
  const double now_s = static_cast<double>(now_ns) * 1e-9;
  // The difference first: that of two rounded times may lie beyond a limit that was just met.
  const double took_s =
      good ? static_cast<double>(now_ns - lua_tointeger(L, kSince)) * 1e-9 : std::nan("");
  const std::string line = check_text(L, kLine, "a line"), name = without_numbers(line);
  const std::string note =
      (name == line ? "" : "'" + line + "': ") + (came ? "it said: " + answer : "no answer");
  self.judge({took_s, Dimension::time, "answer to '" + name + "'"}, How::at_most, std::nullopt,
             check_limit(L, kLimit, Dimension::time), lua_tostring(L, kPlace), now_s, note);
  lua_pushlstring(L, answer.data(), answer.size());
  return 1;
}

// t:ask(line [, pattern [, limit]]) -> the answer's text; "" if none came.
int ask(lua_State* L) {
  Script& self = Script::of(L);
  Stage& stage = self.stage();
  const std::string line = check_text(L, kLine, "a line");
  if (!is_one_line(line)) raise(L, "t:ask: is not one line of ASCII text");
  if (!lua_isnoneornil(L, kPattern)) check_text(L, kPattern, "a pattern");
  lua_settop(L, kLimit);
  if (lua_isnil(L, kLimit)) {
    lua_pushstring(L, "200 ms");
    lua_replace(L, kLimit);
  }
  const std::int64_t limit_ns = check_duration_ns(L, kLimit);
  const std::size_t before = stage.world.heard().size();
  if (auto said = stage.world.say(line); !said) raise(L, said.error());
  lua_pushstring(L, place_of(L).c_str());
  lua_pushinteger(L, static_cast<lua_Integer>(before));
  lua_pushinteger(L, stage.now_ns);
  lua_pushinteger(L, static_cast<lua_Integer>(before));
  lua_pushcclosure(L, heard_more, 1);
  const int ref = luaL_ref(L, LUA_REGISTRYINDEX);
  self.wait_until(stage.now_ns + limit_ns, ref);
  return lua_yieldk(L, 0, ref, answered);
}

// Arguments of t:told.
constexpr int kTold_limit = 2, kTold_words = 3, kTold_place = 4, kTold_before = 5;

// Whether one of the texts from the n-th on has these words.
bool told_since(const std::vector<std::string>& texts, std::size_t n, const std::string& words) {
  return std::any_of(
      texts.begin() + static_cast<std::ptrdiff_t>(std::min(n, texts.size())), texts.end(),
      [&](const std::string& text) { return text.find(words) != std::string::npos; });
}

int told_in_time(lua_State* L) {
  const auto before = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(1)));
  const char* words = lua_tostring(L, lua_upvalueindex(2));
  lua_pushboolean(
      L, static_cast<int>(told_since(Script::of(L).stage().world.told_texts(), before, words)));
  return 1;
}

int after_telling(lua_State* L, int, lua_KContext ref) {
  luaL_unref(L, LUA_REGISTRYINDEX, static_cast<int>(ref));
  Script& self = Script::of(L);
  self.look();
  const auto& texts = self.stage().world.told_texts();
  const std::string words = check_text(L, kTold_words, "words");
  const auto before = static_cast<std::size_t>(lua_tointeger(L, kTold_before));
  const bool came = told_since(texts, before, words);
  const std::int64_t now_ns = self.stage().now_ns;
  const double took_s =
      came ? static_cast<double>(now_ns - lua_tointeger(L, kTold_before + 1)) * 1e-9 : std::nan("");
  const std::string last = texts.size() > before ? "it said: " + texts.back() : "it said nothing";
  self.judge({took_s, Dimension::time, "told '" + words + "'"}, How::at_most, std::nullopt,
             check_limit(L, kTold_limit, Dimension::time), lua_tostring(L, kTold_place),
             static_cast<double>(now_ns) * 1e-9, came ? "" : last);
  lua_pushboolean(L, static_cast<int>(came));
  return 1;
}

// t:told(limit, words) -> whether the firmware told a text with these words between the plan's latest fault,
// command or gust and the limit, which counts from now.
int told(lua_State* L) {
  Script& self = Script::of(L);
  Stage& stage = self.stage();
  const std::int64_t limit_ns = check_duration_ns(L, kTold_limit);
  const std::string words = check_text(L, kTold_words, "words");
  if (words.empty()) raise(L, "t:told: no words");
  lua_settop(L, kTold_words);
  const auto before = static_cast<lua_Integer>(self.told_before());
  lua_pushstring(L, place_of(L).c_str());
  lua_pushinteger(L, before);
  lua_pushinteger(L, stage.now_ns);
  lua_pushinteger(L, before);
  lua_pushstring(L, words.c_str());
  lua_pushcclosure(L, told_in_time, 2);
  const int ref = luaL_ref(L, LUA_REGISTRYINDEX);
  self.wait_until(stage.now_ns + limit_ns, ref);
  return lua_yieldk(L, 0, ref, after_telling);
}

}  // namespace

void add_text_calls(lua_State* L) {
  const luaL_Reg calls[] = {{"ask", ask}, {"told", told}, {nullptr, nullptr}};
  luaL_setfuncs(L, calls, 0);
}

}  // namespace whirl::plan

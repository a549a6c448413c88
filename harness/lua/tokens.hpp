// Lua's text as tokens, for who asks where something stands: comments and white space are left out.
#pragma once
#include <string_view>
#include <vector>

namespace whirl::lua {

struct Token {
  // word: names, keywords and digits; text: a string, quoted or in long brackets; sign: one other
  // character, or "::".
  enum class Kind { word, text, sign } kind;
  std::string_view text;  // of a string without its quotes, escapes as written
  int line;               // where it begins, from 1

  bool is(std::string_view sign) const { return kind == Kind::sign && text == sign; }
};

// Any text: what is open at its end is taken to end there. The tokens point into `source`.
std::vector<Token> tokens_of(std::string_view source);

}  // namespace whirl::lua

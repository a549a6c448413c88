#include "harness/plan/source_calls.hpp"

#include "harness/lua/tokens.hpp"

namespace whirl::plan {

std::vector<SourceCall> source_calls(std::string_view source, int first_line, int last_line) {
  using lua::Token;
  const std::vector<Token> tokens = lua::tokens_of(source);
  std::vector<SourceCall> calls;
  for (std::size_t i = 0; i + 2 < tokens.size(); ++i) {
    const Token &colon = tokens[i], &name = tokens[i + 1], &argument = tokens[i + 2];
    const bool called = argument.kind == Token::Kind::text || argument.is("(") || argument.is("{");
    if (!colon.is(":") || name.kind != Token::Kind::word || !called) continue;
    if (colon.line < first_line || colon.line > last_line) continue;
    calls.push_back({std::string(name.text), colon.line});
  }
  return calls;
}

std::vector<SourceCall> source_words(std::string_view source, int first_line, int last_line) {
  std::vector<SourceCall> words;
  for (const lua::Token& token : lua::tokens_of(source)) {
    if (token.kind == lua::Token::Kind::sign) continue;
    if (token.line < first_line || token.line > last_line) continue;
    words.push_back({std::string(token.text), token.line});
  }
  return words;
}

}  // namespace whirl::plan

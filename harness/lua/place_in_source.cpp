#include "harness/lua/place_in_source.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace whirl::lua {
namespace {

struct Token {
  enum class Kind { word, text, sign } kind;
  std::string_view text;  // of a text without its quotes
  int line;
};

bool word_char(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
}

class Tokens {
 public:
  explicit Tokens(std::string_view source) : source_(source) {
    while (at_ < source_.size()) step();
  }
  std::vector<Token> take() { return std::move(tokens_); }

 private:
  bool sees(std::string_view text) const { return source_.substr(at_, text.size()) == text; }
  void skip_to(std::size_t end) {
    for (; at_ < end && at_ < source_.size(); ++at_) line_ += source_[at_] == '\n' ? 1 : 0;
  }
  std::size_t end_of(std::string_view close, std::size_t from) const {
    const std::size_t found = source_.find(close, from);
    return found == std::string_view::npos ? source_.size() : found;
  }
  void add(Token::Kind kind, std::size_t from, std::size_t to) {
    tokens_.push_back({kind, source_.substr(from, to - from), line_});
  }
  void step() {
    const char c = source_[at_];
    if (std::isspace(static_cast<unsigned char>(c)) != 0) return skip_to(at_ + 1);
    if (sees("--[[")) return skip_to(end_of("]]", at_) + 2);
    if (sees("--")) return skip_to(end_of("\n", at_));
    if (sees("[[")) {
      const std::size_t end = end_of("]]", at_);
      add(Token::Kind::text, at_ + 2, end);
      return skip_to(end + 2);
    }
    if (c == '"' || c == '\'') return quoted(c);
    std::size_t end = at_ + 1;
    const bool word = word_char(c);
    while (word && end < source_.size() && word_char(source_[end])) ++end;
    add(word ? Token::Kind::word : Token::Kind::sign, at_, end);
    skip_to(end);
  }
  void quoted(char quote) {
    std::size_t end = at_ + 1;
    while (end < source_.size() && source_[end] != quote && source_[end] != '\n') {
      end += source_[end] == '\\' ? 2 : 1;
    }
    end = std::min(end, source_.size());
    add(Token::Kind::text, at_ + 1, end);
    skip_to(end + 1);
  }

  std::string_view source_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::vector<Token> tokens_;
};

class Walk {
 public:
  Walk(std::vector<Token> tokens, std::string_view path)
      : tokens_(std::move(tokens)), path_(path) {}

  SourcePlace run() {
    std::size_t start = 0;
    for (std::size_t i = 0; i + 1 < tokens_.size(); ++i) {
      if (tokens_[i].text == "return" && is(i + 1, '{')) start = i + 1;
    }
    at_ = start;
    if (start != 0) table("");
    return best_;
  }

 private:
  bool is(std::size_t i, char sign) const {
    return i < tokens_.size() && tokens_[i].kind == Token::Kind::sign && tokens_[i].text[0] == sign;
  }
  // The one that is longer than all before and on the way to the path, or the path itself.
  void meet(const std::string& path, int line) {
    const bool on_the_way =
        path_.substr(0, path.size()) == path &&
        (path_.size() == path.size() || path_[path.size()] == '.' || path_[path.size()] == '[');
    if (!on_the_way || path.size() <= best_length_) return;
    best_length_ = path.size();
    best_ = {line, path.size() == path_.size()};
  }
  // From the brace that opens it to behind the one that closes it. Left without going deeper where
  // the path does not lead: recursion is as deep as the path.
  void table(const std::string& prefix) {
    ++at_;
    for (int n = 1; at_ < tokens_.size() && !is(at_, '}');) {
      const int line = tokens_[at_].line;
      std::string path;
      if (tokens_[at_].kind == Token::Kind::word && is(at_ + 1, '=')) {
        path = (prefix.empty() ? "" : prefix + ".") + std::string(tokens_[at_].text);
        at_ += 2;
      } else if (is(at_, '[') && is(at_ + 2, ']') && is(at_ + 3, '=')) {
        path = (prefix.empty() ? "" : prefix + ".") + std::string(tokens_[at_ + 1].text);
        at_ += 4;
      } else {
        path = prefix + "[" + std::to_string(n++) + "]";
      }
      meet(path, line);
      const bool deeper = path_.size() > path.size() && path_.substr(0, path.size()) == path;
      if (is(at_, '{') && deeper) table(path);
      skip_value();
    }
    ++at_;
  }
  void skip_value() {
    for (int depth = 0; at_ < tokens_.size(); ++at_) {
      if (depth == 0 && is(at_, '}')) return;
      if (is(at_, '{') || is(at_, '(') || is(at_, '[')) ++depth;
      if (is(at_, '}') || is(at_, ')') || is(at_, ']')) --depth;
      if (depth == 0 && (is(at_, ',') || is(at_, ';'))) {
        ++at_;
        return;
      }
    }
  }

  std::vector<Token> tokens_;
  std::string_view path_;
  std::size_t at_ = 0, best_length_ = 0;
  SourcePlace best_;
};

}  // namespace

SourcePlace place_in_source(std::string_view source, std::string_view path) {
  return Walk(Tokens(source).take(), path).run();
}

}  // namespace whirl::lua

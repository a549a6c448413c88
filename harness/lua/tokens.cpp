#include "harness/lua/tokens.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>

namespace whirl::lua {
namespace {

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

class Reading {
 public:
  explicit Reading(std::string_view source) : source_(source) {}

  std::vector<Token> all() {
    while (at_ < source_.size()) step();
    return std::move(tokens_);
  }

 private:
  struct Span {
    std::size_t begin, end, behind;  // of what is in the brackets, and of the brackets
  };

  bool sees(std::string_view text) const { return source_.substr(at_).starts_with(text); }
  void skip_to(std::size_t end) {
    end = std::min(end, source_.size());
    line_ += static_cast<int>(std::count(source_.begin() + static_cast<std::ptrdiff_t>(at_),
                                         source_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
    at_ = end;
  }
  void add(Token::Kind kind, std::size_t from, std::size_t to) {
    tokens_.push_back({kind, source_.substr(from, to - from), line_});
  }

  // [[ ... ]], [==[ ... ]==]
  std::optional<Span> long_bracket(std::size_t from) const {
    if (from >= source_.size() || source_[from] != '[') return std::nullopt;
    const auto second = source_.find_first_not_of('=', from + 1);
    if (second == std::string_view::npos || source_[second] != '[') return std::nullopt;
    const std::string close = "]" + std::string(second - from - 1, '=') + "]";
    const auto end = std::min(source_.find(close, second + 1), source_.size());
    return Span{second + 1, end, end + close.size()};
  }

  void step() {
    const char c = source_[at_];
    if (std::isspace(static_cast<unsigned char>(c)) != 0) return skip_to(at_ + 1);
    if (sees("--")) {
      const auto comment = long_bracket(at_ + 2);
      return skip_to(comment ? comment->behind : std::min(source_.find('\n', at_), source_.size()));
    }
    if (const auto text = long_bracket(at_)) {
      add(Token::Kind::text, text->begin, text->end);
      return skip_to(text->behind);
    }
    if (c == '"' || c == '\'') return quoted(c);
    std::size_t end = at_ + (sees("::") ? 2 : 1);
    const bool word = is_word(c);
    while (word && end < source_.size() && is_word(source_[end])) ++end;
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

}  // namespace

std::vector<Token> tokens_of(std::string_view source) {
  return Reading(source).all();
}

}  // namespace whirl::lua

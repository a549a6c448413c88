#include "harness/lua/place_in_source.hpp"

#include <string>
#include <vector>

#include "harness/lua/tokens.hpp"

namespace whirl::lua {
namespace {

class Walk {
 public:
  Walk(std::vector<Token> tokens, std::string_view path)
      : tokens_(std::move(tokens)), path_(path) {}

  SourcePlace run() {
    std::size_t start = 0;
    for (std::size_t i = 0; i + 1 < tokens_.size(); ++i) {
      if (tokens_[i].text == "return" && is(i + 1, "{")) start = i + 1;
    }
    at_ = start;
    if (start != 0) table("");
    return best_;
  }

 private:
  bool is(std::size_t i, std::string_view sign) const {
    return i < tokens_.size() && tokens_[i].is(sign);
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
    for (int n = 1; at_ < tokens_.size() && !is(at_, "}");) {
      const int line = tokens_[at_].line;
      std::string path;
      if (tokens_[at_].kind == Token::Kind::word && is(at_ + 1, "=")) {
        path = (prefix.empty() ? "" : prefix + ".") + std::string(tokens_[at_].text);
        at_ += 2;
      } else if (is(at_, "[") && is(at_ + 2, "]") && is(at_ + 3, "=")) {
        path = (prefix.empty() ? "" : prefix + ".") + std::string(tokens_[at_ + 1].text);
        at_ += 4;
      } else {
        path = prefix + "[" + std::to_string(n++) + "]";
      }
      meet(path, line);
      const bool deeper = path_.size() > path.size() && path_.substr(0, path.size()) == path;
      if (is(at_, "{") && deeper) table(path);
      skip_value();
    }
    ++at_;
  }
  void skip_value() {
    for (int depth = 0; at_ < tokens_.size(); ++at_) {
      if (depth == 0 && is(at_, "}")) return;
      if (is(at_, "{") || is(at_, "(") || is(at_, "[")) ++depth;
      if (is(at_, "}") || is(at_, ")") || is(at_, "]")) --depth;
      if (depth == 0 && (is(at_, ",") || is(at_, ";"))) {
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
  return Walk(tokens_of(source), path).run();
}

}  // namespace whirl::lua

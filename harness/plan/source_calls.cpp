#include "harness/plan/source_calls.hpp"

#include <algorithm>
#include <cctype>

namespace whirl::plan {
namespace {

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// Lua's text from one token to the next.
class Walk {
 public:
  explicit Walk(std::string_view source) : rest_(source) {}

  bool at_end() const { return rest_.empty(); }
  int line() const { return line_; }
  char front() const { return rest_.empty() ? '\0' : rest_.front(); }
  bool starts(std::string_view text) const { return rest_.starts_with(text); }

  void pass(std::size_t n) {
    const std::string_view passed = rest_.substr(0, n);
    line_ += static_cast<int>(std::count(passed.begin(), passed.end(), '\n'));
    rest_.remove_prefix(passed.size());
  }
  void pass_spaces() {
    while (std::isspace(static_cast<unsigned char>(front())) != 0) pass(1);
  }
  std::string word() {
    const auto end = std::find_if_not(rest_.begin(), rest_.end(), is_word);
    const std::string text(rest_.begin(), end);
    pass(text.size());
    return text;
  }
  // A comment, a text, or a long bracket. False: none of them is here.
  bool pass_text() {
    if (starts("--")) {
      pass(2);
      if (!pass_long_bracket()) pass(std::min(rest_.find('\n'), rest_.size()));
      return true;
    }
    if (front() == '"' || front() == '\'') {
      pass_quoted();
      return true;
    }
    return pass_long_bracket();
  }

 private:
  void pass_quoted() {
    const char quote = front();
    pass(1);
    while (!at_end() && front() != quote) pass(front() == '\\' ? 2 : 1);
    pass(1);
  }
  // [[ ... ]], [==[ ... ]==]
  bool pass_long_bracket() {
    if (front() != '[') return false;
    const auto level = rest_.find_first_not_of('=', 1);
    if (level == std::string_view::npos || rest_[level] != '[') return false;
    const std::string end = "]" + std::string(level - 1, '=') + "]";
    const auto at = rest_.find(end, level + 1);
    pass(at == std::string_view::npos ? rest_.size() : at + end.size());
    return true;
  }

  std::string_view rest_;
  int line_ = 1;
};

}  // namespace

std::vector<SourceCall> source_calls(std::string_view source, int first_line, int last_line) {
  std::vector<SourceCall> calls;
  for (Walk walk(source); !walk.at_end();) {
    if (walk.pass_text()) continue;
    const int line = walk.line();
    const bool method = walk.front() == ':' && !walk.starts("::");
    walk.pass(walk.starts("::") ? 2 : 1);
    if (!method) continue;
    walk.pass_spaces();
    const std::string name = walk.word();
    walk.pass_spaces();
    const bool called = std::string_view("({\"'[").find(walk.front()) != std::string_view::npos;
    if (!name.empty() && !walk.at_end() && called && line >= first_line && line <= last_line) {
      calls.push_back({name, line});
    }
  }
  return calls;
}

}  // namespace whirl::plan

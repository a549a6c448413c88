// Lua's patterns (reference manual 6.4.1), matched with a bill: each step is taken off the budget.
//
//   Why      string.find of Lua itself is one C call that nothing can stop, and ".-.-.-b" against a long
//            text takes it years
//   Same     as Lua 5.4 in all that matches and in the words of its errors (tests compare the two)
//   Classes  of ASCII, whatever the locale
#pragma once
#include <array>
#include <optional>
#include <string_view>

struct lua_State;

namespace whirl::lua {

// One text against one pattern. Errors in the pattern, and a used up budget, are raised into Lua.
class Matcher {
 public:
  Matcher(lua_State* L, std::string_view text, std::string_view pattern)
      : L_(L), text_(text), pattern_(pattern) {}

  // Where a match that begins at `at` ends; nothing where there is none.
  std::optional<std::size_t> match(std::size_t at);

  // Of the last match, which went from `begin` to `end`. A pattern without captures has the whole match
  // as its first.
  int captures() const { return count_; }
  void push_capture(int i, std::size_t begin, std::size_t end) const;
  int push_captures(std::size_t begin, std::size_t end,
                    bool whole_if_none) const;  // returns how many

 private:
  using End = std::optional<std::size_t>;
  struct Capture {
    static constexpr std::size_t kOpen = SIZE_MAX, kPosition = SIZE_MAX - 1;
    std::size_t begin = 0, size = kOpen;
  };
  static constexpr int kMost_captures = 32, kDeepest = 200;

  struct Item {  // of more than one character of the text: where it ends, and the pattern behind it
    End end;
    std::size_t after = 0;  // 0: the pattern has no such item here
  };
  End run(std::size_t at, std::size_t p);
  Item escape(std::size_t at, std::size_t p);
  End longest(std::size_t at, std::size_t p, std::size_t after);
  End shortest(std::size_t at, std::size_t p, std::size_t after);
  End open_capture(std::size_t at, std::size_t p, std::size_t size);
  End close_capture(std::size_t at, std::size_t p);
  End balanced(std::size_t at, std::size_t p);
  End repeated_capture(std::size_t at, char digit);
  bool at_frontier(std::size_t at, std::size_t set, std::size_t after) const;

  std::size_t class_end(std::size_t p) const;  // the place behind the single item at p
  bool fits(std::size_t at, std::size_t p, std::size_t after) const;
  bool in_set(unsigned char c, std::size_t p, std::size_t last) const;
  unsigned char text_at(std::size_t i) const;
  char pattern_at(std::size_t p) const { return p < pattern_.size() ? pattern_[p] : '\0'; }
  void pay(std::size_t steps) const;

  lua_State* L_;
  std::string_view text_, pattern_;
  std::array<Capture, kMost_captures> captures_{};
  int count_ = 0;
  int depth_ = 0;
};

// Whether the pattern matches anywhere in the text.
bool pattern_found(lua_State* L, std::string_view text, std::string_view pattern);

}  // namespace whirl::lua

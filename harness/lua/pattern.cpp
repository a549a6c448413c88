#include "harness/lua/pattern.hpp"

#include <lua.hpp>

#include "harness/lua/sandbox.hpp"

namespace whirl::lua {
namespace {

bool is_lower(unsigned char c) {
  return c >= 'a' && c <= 'z';
}
bool is_upper(unsigned char c) {
  return c >= 'A' && c <= 'Z';
}
bool is_digit(unsigned char c) {
  return c >= '0' && c <= '9';
}
bool is_graph(unsigned char c) {
  return c > 0x20 && c < 0x7F;
}
bool is_hex(unsigned char c) {
  return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

// %a, %A and their like; any other letter stands for itself.
bool in_class(unsigned char c, unsigned char letter) {
  const bool letter_is_upper = is_upper(letter);
  bool member = false;
  switch (letter_is_upper ? letter - 'A' + 'a' : letter) {
    case 'a':
      member = is_lower(c) || is_upper(c);
      break;
    case 'c':
      member = c < 0x20 || c == 0x7F;
      break;
    case 'd':
      member = is_digit(c);
      break;
    case 'g':
      member = is_graph(c);
      break;
    case 'l':
      member = is_lower(c);
      break;
    case 'p':
      member = is_graph(c) && !is_lower(c) && !is_upper(c) && !is_digit(c);
      break;
    case 's':
      member = c == ' ' || (c >= '\t' && c <= '\r');
      break;
    case 'u':
      member = is_upper(c);
      break;
    case 'w':
      member = is_lower(c) || is_upper(c) || is_digit(c);
      break;
    case 'x':
      member = is_hex(c);
      break;
    default:
      return letter == c;
  }
  return member != letter_is_upper;
}

struct Deeper {
  explicit Deeper(int& depth) : depth_(depth) { ++depth_; }
  ~Deeper() { --depth_; }
  Deeper(const Deeper&) = delete;
  Deeper& operator=(const Deeper&) = delete;
  int& depth_;
};

}  // namespace

void Matcher::pay(std::size_t steps) const {
  Sandbox::spend(L_, static_cast<double>(steps));
}

unsigned char Matcher::text_at(std::size_t i) const {
  return static_cast<unsigned char>(text_[i]);
}

std::optional<std::size_t> Matcher::match(std::size_t at) {
  count_ = 0;
  depth_ = 0;
  return run(at, 0);
}

// The rest of the pattern, from p on, against the text at `at`.
Matcher::End Matcher::run(std::size_t at, std::size_t p) {
  const Deeper deeper(depth_);
  if (depth_ > kDeepest) luaL_error(L_, "pattern too complex");
  while (p < pattern_.size()) {
    pay(1);
    if (pattern_[p] == '(') {
      return pattern_at(p + 1) == ')' ? open_capture(at, p + 2, Capture::kPosition)
                                      : open_capture(at, p + 1, Capture::kOpen);
    }
    if (pattern_[p] == ')') return close_capture(at, p + 1);
    if (pattern_[p] == '$' && p + 1 == pattern_.size()) {
      return at == text_.size() ? End(at) : std::nullopt;
    }
    if (const Item item = escape(at, p); item.after != 0) {
      if (!item.end) return std::nullopt;
      at = *item.end;
      p = item.after;
      continue;
    }
    const std::size_t after = class_end(p);
    const char suffix = pattern_at(after);
    const bool fit = fits(at, p, after);
    if (suffix == '*' && fit) return longest(at, p, after);
    if (suffix == '+') return fit ? longest(at + 1, p, after) : std::nullopt;
    if (suffix == '-' && fit) return shortest(at, p, after);
    if (suffix == '?' && fit) {
      if (const End end = run(at + 1, after + 1)) return end;
    }
    if (suffix == '*' || suffix == '-' || suffix == '?') {  // none of it
      p = after + 1;
      continue;
    }
    if (!fit) return std::nullopt;
    ++at;
    p = after;
  }
  return at;
}

Matcher::Item Matcher::escape(std::size_t at, std::size_t p) {
  if (pattern_[p] != '%') return {};
  const char next = pattern_at(p + 1);
  if (next == 'b') return {balanced(at, p + 2), p + 4};
  if (next == 'f') {
    if (pattern_at(p + 2) != '[') luaL_error(L_, "missing '[' after '%%f' in pattern");
    const std::size_t after = class_end(p + 2);
    return {at_frontier(at, p + 2, after) ? End(at) : std::nullopt, after};
  }
  if (is_digit(static_cast<unsigned char>(next))) return {repeated_capture(at, next), p + 2};
  return {};
}

Matcher::End Matcher::longest(std::size_t at, std::size_t p, std::size_t after) {
  std::size_t n = 0;
  while (fits(at + n, p, after)) ++n;
  for (;; --n) {
    if (const End end = run(at + n, after + 1)) return end;
    if (n == 0) return std::nullopt;
  }
}

Matcher::End Matcher::shortest(std::size_t at, std::size_t p, std::size_t after) {
  for (;; ++at) {
    if (const End end = run(at, after + 1)) return end;
    if (!fits(at, p, after)) return std::nullopt;
  }
}

Matcher::End Matcher::open_capture(std::size_t at, std::size_t p, std::size_t size) {
  if (count_ >= kMost_captures) luaL_error(L_, "too many captures");
  captures_[static_cast<std::size_t>(count_++)] = {at, size};
  const End end = run(at, p);
  if (!end) --count_;
  return end;
}

Matcher::End Matcher::close_capture(std::size_t at, std::size_t p) {
  int i = count_ - 1;
  while (i >= 0 && captures_[static_cast<std::size_t>(i)].size != Capture::kOpen) --i;
  if (i < 0) luaL_error(L_, "invalid pattern capture");
  Capture& capture = captures_[static_cast<std::size_t>(i)];
  capture.size = at - capture.begin;
  const End end = run(at, p);
  if (!end) capture.size = Capture::kOpen;
  return end;
}

// %bxy: from an x to the y that closes it.
Matcher::End Matcher::balanced(std::size_t at, std::size_t p) {
  if (p + 1 >= pattern_.size()) {
    luaL_error(L_, "malformed pattern (missing arguments to '%%b')");
  }
  if (at >= text_.size() || text_[at] != pattern_[p]) return std::nullopt;
  std::size_t open = 1;
  for (std::size_t i = at + 1; i < text_.size(); ++i) {
    pay(1);
    if (text_[i] == pattern_[p + 1]) {
      if (--open == 0) return i + 1;
    } else if (text_[i] == pattern_[p]) {
      ++open;
    }
  }
  return std::nullopt;
}

bool Matcher::at_frontier(std::size_t at, std::size_t set, std::size_t after) const {
  const unsigned char before = at == 0 ? 0 : text_at(at - 1);
  const unsigned char here = at < text_.size() ? text_at(at) : 0;
  return !in_set(before, set, after - 1) && in_set(here, set, after - 1);
}

Matcher::End Matcher::repeated_capture(std::size_t at, char digit) {
  const int i = digit - '1';
  if (i < 0 || i >= count_ || captures_[static_cast<std::size_t>(i)].size == Capture::kOpen) {
    luaL_error(L_, "invalid capture index %%%d", i + 1);
  }
  const Capture& capture = captures_[static_cast<std::size_t>(i)];
  // A position has no length that any rest of the text could have: it never repeats.
  if (text_.size() - at < capture.size) return std::nullopt;
  pay(capture.size / 16);
  if (text_.substr(capture.begin, capture.size) != text_.substr(at, capture.size)) {
    return std::nullopt;
  }
  return at + capture.size;
}

std::size_t Matcher::class_end(std::size_t p) const {
  const char first = pattern_[p++];
  if (first == '%') {
    if (p >= pattern_.size()) luaL_error(L_, "malformed pattern (ends with '%%')");
    return p + 1;
  }
  if (first != '[') return p;
  if (pattern_at(p) == '^') ++p;
  do {  // the first one may be a ']'
    if (p >= pattern_.size()) luaL_error(L_, "malformed pattern (missing ']')");
    p += pattern_[p] == '%' ? 2 : 1;
  } while (pattern_at(p) != ']' || p >= pattern_.size());
  return p + 1;
}

bool Matcher::fits(std::size_t at, std::size_t p, std::size_t after) const {
  if (at >= text_.size()) return false;
  pay(1);
  const unsigned char c = text_at(at);
  switch (pattern_[p]) {
    case '.':
      return true;
    case '%':
      return in_class(c, static_cast<unsigned char>(pattern_[p + 1]));
    case '[':
      return in_set(c, p, after - 1);
    default:
      return static_cast<unsigned char>(pattern_[p]) == c;
  }
}

// [set]: p is at '[', last at ']'.
bool Matcher::in_set(unsigned char c, std::size_t p, std::size_t last) const {
  pay((last - p) / 8);
  const bool complement = pattern_at(p + 1) == '^';
  const auto item = [&](std::size_t i) { return static_cast<unsigned char>(pattern_[i]); };
  for (std::size_t i = p + (complement ? 2 : 1); i < last; ++i) {
    if (item(i) == '%') {
      ++i;
      if (in_class(c, item(i))) return !complement;
    } else if (pattern_at(i + 1) == '-' && i + 2 < last) {
      if (item(i) <= c && c <= item(i + 2)) return !complement;
      i += 2;
    } else if (item(i) == c) {
      return !complement;
    }
  }
  return complement;
}

void Matcher::push_capture(int i, std::size_t begin, std::size_t end) const {
  if (i >= count_) {
    if (i != 0) luaL_error(L_, "invalid capture index %%%d", i + 1);
    lua_pushlstring(L_, text_.data() + begin, end - begin);
    return;
  }
  const Capture& capture = captures_[static_cast<std::size_t>(i)];
  if (capture.size == Capture::kOpen) luaL_error(L_, "unfinished capture");
  if (capture.size == Capture::kPosition) {
    lua_pushinteger(L_, static_cast<lua_Integer>(capture.begin) + 1);
  } else {
    lua_pushlstring(L_, text_.data() + capture.begin, capture.size);
  }
}

int Matcher::push_captures(std::size_t begin, std::size_t end, bool whole_if_none) const {
  const int n = count_ == 0 && whole_if_none ? 1 : count_;
  luaL_checkstack(L_, n, "too many captures");
  for (int i = 0; i < n; ++i) push_capture(i, begin, end);
  return n;
}

bool pattern_found(lua_State* L, std::string_view text, std::string_view pattern) {
  const bool anchored = !pattern.empty() && pattern[0] == '^';
  Matcher matcher(L, text, pattern.substr(anchored ? 1 : 0));
  for (std::size_t at = 0; at <= text.size(); ++at) {
    if (matcher.match(at)) return true;
    if (anchored) break;
  }
  return false;
}

}  // namespace whirl::lua
